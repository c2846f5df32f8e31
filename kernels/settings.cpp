#include "kernels/settings.h"

#include <stdexcept>

namespace boxwood {

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
                                std::string(owner) + "' must lie between " +
                                std::to_string(setting.least) + " and " +
                                std::to_string(setting.most) + ", not " + std::to_string(value));
}

} // namespace boxwood
