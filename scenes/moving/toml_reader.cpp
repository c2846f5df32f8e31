#include "scenes/moving/toml_reader.h"

#include "kernels/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace boxwood {

toml::table TomlReader::parse(std::string_view text) const {
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        fail(error.source(), fmt::format("not TOML: {}", error.description()));
    }
}

std::string TomlReader::place(const toml::source_region& source) const {
    return fmt::format("{}:{}", file_, source.begin.line);
}

void TomlReader::fail(const toml::source_region& source, const std::string& message) const {
    throw std::invalid_argument(place(source) + ": " + message);
}

void TomlReader::require_known_keys(const toml::table& table, std::string_view where,
                                    const Names& known) const {
    for (const auto& [key, value] : table)
        if (std::ranges::find(known, key.str()) == known.end())
            fail(key.source(), unknown_name(fmt::format("key of {}", where), key.str(), known));
}

double TomlReader::number(const toml::node& node, std::string_view key, double min,
                          double max) const {
    const auto value = node.value<double>();
    if (!value || !node.is_number())
        fail(node.source(), fmt::format("{} must be a number", key));
    if (!(*value >= min && *value <= max))
        fail(node.source(), fmt::format("{} = {} is out of range: it must lie between {} and {}",
                                        key, *value, min, max));
    return *value;
}

std::uint64_t TomlReader::whole(const toml::node& node, std::string_view key, std::int64_t min,
                                std::int64_t max) const {
    if (!node.is_integer())
        fail(node.source(), fmt::format("{} must be a whole number", key));
    const std::int64_t value = *node.value<std::int64_t>();
    if (value < min || value > max)
        fail(node.source(), fmt::format("{} = {} is out of range: it must lie between {} and {}",
                                        key, value, min, max));
    return static_cast<std::uint64_t>(value);
}

SettingValue TomlReader::setting(const toml::node& node, std::string_view key) const {
    if (const auto* whole = node.as_integer())
        return whole->get();
    if (const auto* on = node.as_boolean())
        return on->get();
    if (const auto* name = node.as_string())
        return name->get();
    using Limits = std::numeric_limits<double>;
    return number(node, key, Limits::lowest(), Limits::max());
}

std::string TomlReader::text(const toml::node& node, std::string_view key) const {
    const auto value = node.value<std::string>();
    if (!value)
        fail(node.source(), fmt::format("{} must be a text in quotes", key));
    return *value;
}

void TomlReader::require_known(const toml::node& node, std::string_view key, std::string_view name,
                               const Names& known) const {
    if (std::ranges::find(known, name) == known.end())
        fail(node.source(), fmt::format("{}: {}", key, unknown_name("name", name, known)));
}

std::string TomlReader::name(const toml::node& node, std::string_view key,
                             const Names& known) const {
    const auto value = node.value<std::string>();
    if (!value)
        fail(node.source(), fmt::format("{} must be a name in quotes", key));
    require_known(node, key, *value, known);
    return *value;
}

void TomlReader::names(const toml::table& table, std::string_view key,
                       std::vector<std::string>& out, const Names& known) const {
    list(table, key, out, [&](const toml::node& node) { return name(node, key, known); });
}

} // namespace boxwood
