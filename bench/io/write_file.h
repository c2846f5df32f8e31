#pragma once

#include <string>
#include <string_view>

namespace boxwood::bench {

/// Writes what `option` names: a plain file as a whole or not at all, with the permissions of the
/// one that it replaces, and where a link leads; a pipe or a device as it is. Throws BadInput that
/// says why.
void write_file(const std::string& name, std::string_view content, std::string_view option);

} // namespace boxwood::bench
