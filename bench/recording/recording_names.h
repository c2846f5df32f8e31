#pragma once

#include <filesystem>
#include <string>

/// Between `boxwood record` and what it loads into a program.
namespace boxwood::recording {

inline constexpr const char* file_variable = "BOXWOOD_RECORD";
/// Of a program: managers that come after those are not recorded.
inline constexpr unsigned most_files = 64;

/// program.h5, program-2.h5, program-3.h5 ...
inline std::filesystem::path numbered(const std::filesystem::path& first, unsigned i) {
    if (i == 1)
        return first;
    std::filesystem::path file = first;
    return file.replace_filename(first.stem().string() + "-" + std::to_string(i) +
                                 first.extension().string());
}

} // namespace boxwood::recording
