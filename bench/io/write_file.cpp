#include "bench/io/write_file.h"

#include "bench/io/bad_input.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

void check(bool is_done) {
    if (!is_done)
        throw std::system_error(errno, std::generic_category());
}

/// Closes the file in any case.
void write_all(std::FILE* file, std::string_view content) {
    check(file != nullptr);
    const bool is_written = std::fwrite(content.data(), 1, content.size(), file) == content.size();
    const int why = errno;
    const bool is_closed = std::fclose(file) == 0;
    if (!is_written)
        errno = why;
    check(is_written && is_closed);
}

/// Where a file is or will be; the links are no circle.
fs::path end_of_links(fs::path file) {
    while (fs::is_symlink(file))
        file = file.parent_path() / fs::read_symlink(file);
    return file;
}

void replace(const fs::path& file, fs::file_status there, std::string_view content) {
    check(!exists(there) || ::access(file.c_str(), W_OK) == 0);
    const std::string temporary = fmt::format("{}.tmp-{}", file.string(), ::getpid());
    std::FILE* const made = std::fopen(temporary.c_str(), "wbx"); // none that is another's
    try {
        write_all(made, content);
        if (exists(there))
            fs::permissions(temporary, there.permissions());
        fs::rename(temporary, file);
    } catch (...) {
        std::error_code ignored;
        if (made)
            fs::remove(temporary, ignored);
        throw;
    }
}

} // namespace

void write_file(const std::string& name, std::string_view content, std::string_view option) try {
    const fs::file_status there = fs::status(name);
    if (exists(there) && !is_regular_file(there))
        write_all(std::fopen(name.c_str(), "wb"), content);
    else
        replace(end_of_links(name), there, content);
} catch (const std::system_error& error) {
    throw BadInput(
        fmt::format("{} {}: cannot be written: {}", option, name, error.code().message()));
}

} // namespace boxwood::bench
