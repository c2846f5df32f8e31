#pragma once

#include "results/detail/handle.h"

#include <filesystem>

namespace boxwood::results::detail {

/// Throws std::runtime_error with the cause alone for what is no regular file, or is empty.
void require_file(const std::filesystem::path& file);

/// The whole file, taken into memory: no lock, and no way back to the disk. Throws
/// std::runtime_error with the cause alone for one that is not HDF5.
Handle open_to_read(const std::filesystem::path& file);

} // namespace boxwood::results::detail
