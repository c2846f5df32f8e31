#pragma once

#include <span>
#include <string>
#include <string_view>

namespace boxwood::bench {

/// The names that `boxwood list` takes: "builders", "layouts", ...
std::span<const std::string_view> registry_names();

/// For an empty name a summary of all registries that fits one screen, else one registry with a
/// line or more for each name. As JSON a list of objects with at least "name" and "summary", or for
/// all registries one object of such lists. Throws std::invalid_argument, with a suggestion, for an
/// unknown name.
std::string list_text(std::string_view name, bool json);

} // namespace boxwood::bench
