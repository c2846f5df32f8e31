#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

/// One number of a registry type, such as a builder, that the user may set.
template <class T> struct Setting {
    std::string_view name, summary;
    double T::*value;
    double least, most;
};

/// The same without the type.
struct SettingInfo {
    std::string_view name, summary;
    double default_value, least, most;
};

/// What the user sets, by name.
using Settings = std::map<std::string, double, std::less<>>;

[[noreturn]] void throw_unknown_setting(std::string_view owner, std::string_view setting,
                                        std::span<const SettingInfo> known);
[[noreturn]] void throw_setting_range(std::string_view owner, const SettingInfo& setting,
                                      double value);

template <class T> std::vector<SettingInfo> setting_infos() {
    std::vector<SettingInfo> infos;
    if constexpr (requires { T::settings(); })
        for (const Setting<T>& s : T::settings())
            infos.push_back({s.name, s.summary, T{}.*(s.value), s.least, s.most});
    return infos;
}

/// A T with these settings. Throws std::invalid_argument for an unknown or out-of-range one.
template <class T> T with_settings(const Settings& values) {
    T made;
    const std::vector<SettingInfo> infos = setting_infos<T>();
    for (const auto& [name, value] : values) {
        bool known = false;
        if constexpr (requires { T::settings(); })
            for (std::size_t i = 0; const Setting<T>& s : T::settings()) {
                if (s.name == name) {
                    if (!(value >= s.least && value <= s.most))
                        throw_setting_range(T::name, infos[i], value);
                    made.*(s.value) = value;
                    known = true;
                }
                ++i;
            }
        if (!known)
            throw_unknown_setting(T::name, name, infos);
    }
    return made;
}

} // namespace boxwood
