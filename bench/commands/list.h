#pragma once

#include <span>
#include <string>
#include <string_view>

namespace boxwood::bench {

/// The words that `boxwood list` takes: "builders", "layouts", ...
std::span<const std::string_view> catalogue_names();

/// One registry, or all for an empty name. As text a line per entry; as JSON a list of objects
/// with at least "name" and "summary", or for all registries one object of such lists. Throws
/// BadInput for an unknown name.
std::string list_catalogues(std::string_view name, bool json);

} // namespace boxwood::bench
