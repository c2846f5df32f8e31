#pragma once

#include <cstdint>
#include <filesystem>

namespace boxwood::bench {

/// Bytes that this process may still use without the system swapping or killing it: what the kernel
/// calls available (MemAvailable), or what is left of the limit of a control group around us, if
/// that is less: of version 1 or 2, ours or one above it. Reads /proc and /sys below `root`; the
/// largest number if these say nothing.
std::uint64_t available_memory(const std::filesystem::path& root = "/");

} // namespace boxwood::bench
