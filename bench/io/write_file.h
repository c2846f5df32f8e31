#pragma once

#include <filesystem>
#include <string_view>

namespace boxwood::bench {

/// Writes a file, a pipe or a device, and where a link leads; what is the program's own output,
/// too, follows what was printed there. A plain file for which the disk has no room keeps what it
/// has. Throws BadInput: "`what`: cannot be written: why".
void write_file(const std::filesystem::path& name, std::string_view content, std::string_view what);

} // namespace boxwood::bench
