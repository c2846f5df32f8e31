#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace boxwood {

/// What the user sets, by name: numbers, true or false, or the name of one of several choices.
using SettingValue = std::variant<std::int64_t, double, bool, std::string>;
using Settings = std::map<std::string, SettingValue, std::less<>>;

/// "16", "0.5", "true" or a name as it is; numbers in their shortest form.
std::string to_text(const SettingValue& value);

/// A setting for lists and checks, without the type that it belongs to.
struct SettingInfo {
    std::string_view name, summary;
    SettingValue default_value;            ///< has the setting's type; that of a choice is a name
    double min = 0, max = 0;               ///< of a number
    std::vector<std::string_view> choices; ///< of an enum whose values are 0, 1, 2 ...
};

/// The range or the choices of a setting: "2 to 32", "true or false", "morton or hilbert".
std::string allowed_values(const SettingInfo& setting);

/// The value in the type of the setting; a whole number will do for a double.
/// Throws std::invalid_argument, which names owner, setting, what is allowed and the value.
SettingValue checked_setting(std::string_view owner, const SettingInfo& setting,
                             const SettingValue& value);

[[noreturn]] void throw_unknown_setting(std::string_view owner, std::string_view setting,
                                        const std::vector<SettingInfo>& known);

/// A data member of a registry type T, such as a builder, that the user may set.
template <class T> struct Setting {
    Setting(std::string_view name_, std::string_view summary_, int T::*member, int min, int max)
        : Setting(
              SettingInfo{name_, summary_, std::int64_t{T{}.*member}, double(min), double(max), {}},
              [member](T& to, const SettingValue& value) {
                  to.*member = static_cast<int>(std::get<std::int64_t>(value));
              }) {}
    Setting(std::string_view name_, std::string_view summary_, double T::*member, double min,
            double max)
        : Setting(SettingInfo{name_, summary_, T{}.*member, min, max, {}},
                  [member](T& to, const SettingValue& value) {
                      to.*member = std::get<double>(value);
                  }) {}
    Setting(std::string_view name_, std::string_view summary_, bool T::*member)
        : Setting(
              SettingInfo{name_, summary_, T{}.*member, 0, 0, {}},
              [member](T& to, const SettingValue& value) { to.*member = std::get<bool>(value); }) {}
    /// choices: the names of the values 0, 1, 2 ... of the enum.
    template <class Enum>
    requires std::is_enum_v<Enum> Setting(std::string_view name_, std::string_view summary_,
                                          Enum T::*member, std::vector<std::string_view> choices)
        : Setting(SettingInfo{name_, summary_,
                              std::string(choices[static_cast<std::size_t>(T{}.*member)]), 0, 0,
                              choices},
                  [member, choices](T& to, const SettingValue& value) {
                      std::size_t i = 0;
                      while (choices[i] != std::get<std::string>(value))
                          ++i;
                      to.*member = static_cast<Enum>(i);
                  }) {}

    SettingInfo info;
    std::function<void(T&, const SettingValue&)> set; ///< takes a value that was checked

  private:
    Setting(SettingInfo info_, std::function<void(T&, const SettingValue&)> set_)
        : info(std::move(info_)), set(std::move(set_)) {}
};

template <class T>
concept HasSettings = requires {
    T::settings();
};

/// What T::settings() must be, if there is one: a range of Setting<T>.
template <class T>
concept ListsSettings =
    !HasSettings<T> || std::convertible_to<decltype(*T::settings().begin()), const Setting<T>&>;

/// The settings that T lists by `T::settings()`, if it does.
template <class T> std::vector<SettingInfo> setting_infos() {
    std::vector<SettingInfo> infos;
    if constexpr (HasSettings<T>)
        for (const Setting<T>& setting : T::settings())
            infos.push_back(setting.info);
    return infos;
}

/// A T with these settings. Throws std::invalid_argument for an unknown or out-of-range one.
template <class T> T with_settings(const Settings& values) {
    T made;
    for (const auto& [name, value] : values) {
        bool known = false;
        if constexpr (HasSettings<T>)
            for (const Setting<T>& setting : T::settings())
                if (setting.info.name == name) {
                    setting.set(made, checked_setting(T::name, setting.info, value));
                    known = true;
                }
        if (!known)
            throw_unknown_setting(T::name, name, setting_infos<T>());
    }
    return made;
}

} // namespace boxwood
