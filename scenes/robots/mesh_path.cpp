#include "scenes/robots/mesh_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <vector>

namespace boxwood {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
}

/// Where a file was looked for.
class Search {
  public:
    std::optional<fs::path> found;

    void look_at(const fs::path& path) {
        if (found)
            return;
        const fs::path normal = path.lexically_normal();
        if (std::ranges::find(tried_, normal) == tried_.end())
            tried_.push_back(normal);
        if (is_file(normal))
            found = normal;
    }
    std::string places() const {
        constexpr std::size_t shown = 4;
        std::string text;
        for (std::size_t i = 0; i < std::min(tried_.size(), shown); ++i)
            text += (i ? ", " : "") + tried_[i].string();
        return tried_.size() > shown
                   ? fmt::format("{} and {} places more", text, tried_.size() - shown)
                   : text;
    }

  private:
    std::vector<fs::path> tried_;
};

/// PATH from its last folder `meshes` on; empty if it has none.
fs::path from_meshes(const fs::path& path) {
    fs::path tail;
    bool in_meshes = false;
    for (const fs::path& part : path) {
        if (part == "meshes")
            tail.clear(), in_meshes = true;
        if (in_meshes)
            tail /= part;
    }
    return tail;
}

std::vector<fs::path> folders_upwards(const fs::path& file) {
    std::error_code error;
    fs::path folder = fs::absolute(file, error).lexically_normal().parent_path();
    std::vector<fs::path> folders;
    while (!folder.empty()) {
        folders.push_back(folder);
        const fs::path above = folder.parent_path();
        if (above == folder)
            break;
        folder = above;
    }
    return folders;
}

fs::path in_package(const std::string& package, const fs::path& path, const fs::path& urdf_file,
                    std::span<const fs::path> package_folders) {
    Search search;
    const auto look_in = [&](fs::path folder) {
        if (!folder.has_filename()) // "packages/"
            folder = folder.parent_path();
        if (folder.filename() == package)
            search.look_at(folder / path);
        search.look_at(folder / package / path);
    };
    for (const fs::path& folder : package_folders)
        look_in(folder);
    if (package_folders.empty()) {
        const std::vector<fs::path> folders = folders_upwards(urdf_file);
        for (const fs::path& folder : folders)
            look_in(folder);
        if (const fs::path tail = from_meshes(path); !tail.empty())
            for (const fs::path& folder : folders)
                search.look_at(folder / tail);
    }
    if (!search.found)
        throw std::runtime_error(
            fmt::format("mesh package://{0}/{1} is not at {2}; name the folder that holds the "
                        "package '{0}' (--package-path DIR)",
                        package, path.string(), search.places()));
    return *search.found;
}

/// %41 -> A; what is no such code stays.
std::string decoded(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned code = 0;
        const char* const digits = text.data() + i + 1;
        if (text[i] == '%' && i + 2 < text.size() &&
            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
            out += static_cast<char>(code);
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

bool take_prefix(std::string_view& text, std::string_view prefix) {
    if (!text.starts_with(prefix))
        return false;
    text.remove_prefix(prefix.size());
    return true;
}

} // namespace

fs::path mesh_path(std::string_view name, const fs::path& urdf_file,
                   std::span<const fs::path> package_folders) {
    std::string_view rest = name;
    if (take_prefix(rest, "package://") || take_prefix(rest, "model://")) {
        const std::size_t slash = rest.find('/');
        if (slash == 0 || slash == std::string_view::npos || slash + 1 == rest.size())
            throw std::runtime_error(
                fmt::format("mesh '{}': package://PACKAGE/PATH is wanted", name));
        return in_package(std::string(rest.substr(0, slash)),
                          fs::path(rest.substr(slash + 1)).relative_path(), urdf_file,
                          package_folders);
    }
    const bool is_uri = take_prefix(rest, "file://");
    if (!is_uri && rest.find("://") != std::string_view::npos)
        throw std::runtime_error(fmt::format("mesh '{}': only package://, file:// and paths are "
                                             "read; fetch the file and name its path",
                                             name));
    const fs::path path = is_uri ? fs::path(decoded(rest)) : fs::path(rest);
    const fs::path file =
        (path.is_absolute() ? path : urdf_file.parent_path() / path).lexically_normal();
    if (!is_file(file))
        throw std::runtime_error(
            fmt::format("mesh {} is not there; paths are taken from the folder of the URDF file",
                        file.string()));
    return file;
}

} // namespace boxwood
