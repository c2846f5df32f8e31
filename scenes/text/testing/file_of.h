#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace boxwood {

/// A file with this text, gone with the object.
class FileOf {
  public:
    explicit FileOf(const std::string& text)
        : path_(std::filesystem::temp_directory_path() /
                ("boxwood_file_" + std::to_string(std::random_device{}()))) {
        std::ofstream(path_, std::ios::binary) << text;
    }
    ~FileOf() { std::filesystem::remove(path_); }
    FileOf(const FileOf&) = delete;
    FileOf& operator=(const FileOf&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

} // namespace boxwood
