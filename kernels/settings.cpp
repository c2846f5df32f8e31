#include "kernels/settings.h"

#include "kernels/suggest.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace boxwood {
namespace {

std::string number_text(std::int64_t x) { return std::to_string(x); }

/// The shortest text that reads back as x: "32", "0.5", "1000000", "1e+300".
std::string number_text(double x) {
    const double size = std::abs(x);
    const auto format = size == 0 || (size >= 1e-4 && size < 1e16) ? std::chars_format::fixed
                                                                   : std::chars_format::scientific;
    std::array<char, 32> digits;
    return {digits.data(), std::to_chars(digits.begin(), digits.end(), x, format).ptr};
}

/// The value as a number, if it is one.
std::optional<double> number_of(const SettingValue& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value))
        return static_cast<double>(*whole);
    const auto* number = std::get_if<double>(&value);
    return number ? std::optional(*number) : std::nullopt;
}

/// What the value must be: "a whole number from 2 to 32", "morton or hilbert".
std::string demand(const SettingInfo& setting) {
    if (!number_of(setting.default_value))
        return allowed_values(setting);
    const bool whole = std::holds_alternative<std::int64_t>(setting.default_value);
    return (whole ? "a whole number from " : "a number from ") + allowed_values(setting);
}

/// The value in the type of the setting, if it is allowed.
std::optional<SettingValue> convert(const SettingInfo& setting, const SettingValue& value) {
    if (!setting.choices.empty()) {
        const auto* name = std::get_if<std::string>(&value);
        const bool known =
            name && std::ranges::find(setting.choices, *name) != setting.choices.end();
        return known ? std::optional(value) : std::nullopt;
    }
    if (const auto number = number_of(value);
        number && !(*number >= setting.min && *number <= setting.max))
        return std::nullopt;
    if (std::holds_alternative<double>(setting.default_value))
        return number_of(value);
    return value.index() == setting.default_value.index() ? std::optional(value) : std::nullopt;
}

} // namespace

std::string to_text(const SettingValue& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value))
        return number_text(*whole);
    if (const auto* number = std::get_if<double>(&value))
        return number_text(*number);
    if (const auto* on = std::get_if<bool>(&value))
        return *on ? "true" : "false";
    return std::get<std::string>(value);
}

std::string allowed_values(const SettingInfo& setting) {
    if (std::holds_alternative<bool>(setting.default_value))
        return "true or false";
    if (setting.choices.empty())
        return number_text(setting.min) + " to " + number_text(setting.max);
    std::string all;
    for (std::size_t i = 0; i < setting.choices.size(); ++i)
        all += (i == 0                           ? ""
                : i + 1 < setting.choices.size() ? ", "
                                                 : " or ") +
               std::string(setting.choices[i]);
    return all;
}

SettingValue checked_setting(std::string_view owner, const SettingInfo& setting,
                             const SettingValue& value) {
    if (auto converted = convert(setting, value))
        return *converted;
    throw std::invalid_argument("setting '" + std::string(setting.name) + "' of '" +
                                std::string(owner) + "' must be " + demand(setting) + ", not " +
                                to_text(value));
}

void throw_unknown_setting(std::string_view owner, std::string_view setting,
                           const std::vector<SettingInfo>& known) {
    std::string message =
        "'" + std::string(owner) + "' has no setting '" + std::string(setting) + "'; it has ";
    for (std::size_t i = 0; i < known.size(); ++i)
        message += (i == 0 ? "" : ", ") + std::string(known[i].name);
    if (known.empty())
        message += "none";
    if (const std::string near = suggest(setting, names_of(known)); !near.empty())
        message += "; did you mean '" + near + "'?";
    throw std::invalid_argument(message);
}

} // namespace boxwood
