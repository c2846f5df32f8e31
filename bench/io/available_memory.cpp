#include "bench/io/available_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace boxwood::bench {
namespace {

using std::filesystem::path;

std::optional<std::uint64_t> number_in(const path& file) {
    std::ifstream stream(file);
    std::uint64_t number = 0;
    if (stream >> number)
        return number;
    return {}; // no such file, or "max"
}

/// The number after a word at the begin of a line: "MemAvailable:   123 kB", "inactive_file 123".
std::optional<std::uint64_t> number_after(const std::string& word, const path& file) {
    std::ifstream stream(file);
    for (std::string first; stream >> first; stream.ignore(1 << 16, '\n'))
        if (std::uint64_t number = 0; first == word && stream >> number)
            return number;
    return {};
}

/// The names that a version of control groups gives its files.
struct Names {
    const char *limit, *used, *reclaimable;
};
constexpr Names version_1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr Names version_2{"memory.max", "memory.current", "inactive_file"};

/// What is left in a group and in those above it, of whose limits each holds. Of what is used, the
/// file cache that nobody reads is given back when memory is short.
std::uint64_t left_in(const path& mount, path group, const Names& names) {
    std::uint64_t left = std::numeric_limits<std::uint64_t>::max();
    for (group = group.relative_path();; group = group.parent_path()) {
        const path folder = mount / group;
        const auto limit = number_in(folder / names.limit), used = number_in(folder / names.used);
        if (limit && used) {
            const std::uint64_t cache =
                number_after(names.reclaimable, folder / "memory.stat").value_or(0);
            const std::uint64_t taken = *used - std::min(*used, cache);
            left = std::min(left, *limit - std::min(*limit, taken));
        }
        if (group.empty())
            return left;
    }
}

} // namespace

std::uint64_t available_memory(const path& root) {
    std::uint64_t available = std::numeric_limits<std::uint64_t>::max();
    if (const auto kilobytes = number_after("MemAvailable:", root / "proc/meminfo"))
        available = *kilobytes << 10;
    // Lines NUMBER:CONTROLLERS:PATH; version 2 has no controllers. In a container the path may be
    // the host's, which is not there: then the limits are those of the mount itself.
    std::ifstream groups(root / "proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos)
            continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
        const path group = line.substr(second + 1), mount = root / "sys/fs/cgroup";
        if (controllers.find(",memory,") != std::string::npos)
            available = std::min(available, left_in(mount / "memory", group, version_1));
        else if (controllers == ",,")
            available = std::min(available, left_in(mount, group, version_2));
    }
    return available;
}

} // namespace boxwood::bench
