#include "kernels/settings.h"

#include <array>
#include <charconv>
#include <stdexcept>

namespace boxwood {
namespace {

/// The shortest text that reads back as x: "32", "0.5", "1e+300".
std::string text(double x) {
    std::array<char, 32> digits;
    return {digits.begin(), std::to_chars(digits.begin(), digits.end(), x).ptr};
}

} // namespace

void throw_unknown_setting(std::string_view owner, std::string_view setting,
                           std::span<const SettingInfo> known) {
    std::string message =
        "'" + std::string(owner) + "' has no setting '" + std::string(setting) + "'; it has ";
    for (std::size_t i = 0; i < known.size(); ++i)
        message += (i ? ", " : "") + std::string(known[i].name);
    throw std::invalid_argument(known.empty() ? message + "none" : message);
}

void throw_setting_range(std::string_view owner, const SettingInfo& setting, double value) {
    throw std::invalid_argument("setting '" + std::string(setting.name) + "' of '" +
                                std::string(owner) + "' must lie between " + text(setting.least) +
                                " and " + text(setting.most) + ", not " + text(value));
}

} // namespace boxwood
