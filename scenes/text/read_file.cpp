#include "scenes/text/read_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <memory>

namespace boxwood {

namespace fs = std::filesystem;

std::string read_stream(std::FILE* stream, const std::string& name) {
    std::string bytes;
    for (std::size_t got = 1; got != 0;) {
        const std::size_t size = bytes.size();
        bytes.resize(size + (std::size_t{1} << 20));
        got = std::fread(bytes.data() + size, 1, bytes.size() - size, stream);
        bytes.resize(size + got);
    }
    if (std::ferror(stream))
        throw BadInput(
            fmt::format("{}: cannot be read: {}", name, std::strerror(errno ? errno : EIO)));
    return bytes;
}

std::string read_file(const fs::path& file, std::string_view kind) {
    struct Close {
        void operator()(std::FILE* stream) const { std::fclose(stream); }
    };
    const std::string name =
        kind.empty() ? file.string() : fmt::format("{} {}", kind, file.string());
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found)
        throw BadInput(name + ": no such file");
    if (fs::is_directory(status))
        throw BadInput(name + ": is a folder; name a file in it");
    errno = 0;
    const std::unique_ptr<std::FILE, Close> stream(std::fopen(file.c_str(), "rb"));
    if (!stream)
        throw BadInput(fmt::format("{}: cannot be read: {}", name, std::strerror(errno)));
    return read_stream(stream.get(), name);
}

} // namespace boxwood
