#pragma once

#include "trees/executor.h"
#include "trees/tree.h"

#include <concepts>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

/// A builder makes the canonical tree of any number of boxes: the same tree on every executor.
/// It throws InvalidBox for a box with a NaN, an infinity or min > max. Its settings are documented
/// data members with defaults, listed by `settings()` so that a sweep file can reach them.
template <class B>
concept Builder = std::default_initializable<B> &&
    requires(const B builder, Boxes boxes, const Executor& executor) {
    { builder.build(boxes, executor) } -> std::same_as<Tree>;
    { B::name } -> std::convertible_to<std::string_view>;
    { B::summary } -> std::convertible_to<std::string_view>;
};

/// One number that a builder lets the user set.
template <class B> struct Setting {
    std::string_view name, summary;
    double B::*value;
    double least, most;
};

struct SettingInfo {
    std::string_view name, summary;
    double default_value, least, most;
};

using Settings = std::map<std::string, double, std::less<>>;
using BuildFunction = std::function<Tree(Boxes, const Executor&)>;

/// A catalogue row. `make` throws std::invalid_argument for an unknown or out-of-range setting.
struct BuilderEntry {
    std::string_view name, summary;
    std::vector<SettingInfo> settings;
    std::function<BuildFunction(const Settings&)> make;
};

std::span<const BuilderEntry> builders();

/// The builder by its catalogue word, or nullptr.
const BuilderEntry* find_builder(std::string_view name);

[[noreturn]] void throw_unknown_setting(std::string_view builder, std::string_view setting,
                                        std::span<const SettingInfo> known);
[[noreturn]] void throw_setting_range(std::string_view builder, const SettingInfo& setting,
                                      double value);

/// The catalogue row of a Builder type.
template <Builder B> BuilderEntry builder_entry() {
    std::vector<SettingInfo> infos;
    if constexpr (requires { B::settings(); })
        for (const Setting<B>& s : B::settings())
            infos.push_back({s.name, s.summary, B{}.*(s.value), s.least, s.most});
    auto make = [infos](const Settings& values) -> BuildFunction {
        B builder;
        for (const auto& [name, value] : values) {
            bool known = false;
            if constexpr (requires { B::settings(); })
                for (std::size_t i = 0; const Setting<B>& s : B::settings()) {
                    if (s.name == name) {
                        if (!(value >= s.least && value <= s.most))
                            throw_setting_range(B::name, infos[i], value);
                        builder.*(s.value) = value;
                        known = true;
                    }
                    ++i;
                }
            if (!known)
                throw_unknown_setting(B::name, name, infos);
        }
        return [builder](Boxes boxes, const Executor& executor) {
            return builder.build(boxes, executor);
        };
    };
    return {B::name, B::summary, std::move(infos), std::move(make)};
}

} // namespace boxwood
