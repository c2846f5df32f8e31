#pragma once

#include <filesystem>
#include <string_view>

namespace boxwood::bench {

/// Writes a file, a pipe or a device, and where a link leads; what is the program's own output,
/// too, follows what was printed there. A plain file keeps what it has where the disk has no room,
/// if the file system can tell beforehand. Throws BadInput: "`what`: cannot be written: why".
void write_file(const std::filesystem::path& name, std::string_view content, std::string_view what);

} // namespace boxwood::bench
