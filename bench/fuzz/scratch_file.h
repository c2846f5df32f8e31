#pragma once

#include "bench/fuzz/fuzz.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace boxwood::fuzz {

/// A file for code that takes a path: in $TMPDIR, removed at the end.
class ScratchFile {
  public:
    explicit ScratchFile(std::string_view extension)
        : path_(std::filesystem::temp_directory_path() /
                ("boxwood_fuzz_" + std::to_string(::getpid()) + std::string(extension))) {}
    ~ScratchFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    ScratchFile(const ScratchFile&) = delete;

    const std::filesystem::path& holding(Bytes bytes) const {
        std::ofstream(path_, std::ios::binary) << text_of(bytes);
        return path_;
    }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

} // namespace boxwood::fuzz
