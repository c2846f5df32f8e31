#include "scenes/meshes/mesh_scan.h"

#include <fmt/format.h>

#include <cstring>

namespace boxwood {

/// Binary: 80 bytes of header (which may begin with "solid" as well), the number of triangles, 50
/// bytes each. So the size distinguishes the two kinds.
void scan_stl(std::string_view bytes, NotFinite not_finite) {
    constexpr std::size_t header = 84, per_triangle = 50;
    std::uint32_t count = 0;
    if (bytes.size() >= header)
        std::memcpy(&count, bytes.data() + 80, sizeof count);
    const std::size_t expected = header + per_triangle * count;
    if (bytes.size() >= header && bytes.size() == expected)
        return;
    const bool text = bytes.substr(0, bytes.find('\0')).size() == bytes.size();
    if (!text || !bytes.starts_with("solid"))
        throw MeshError(
            bytes.size() < header
                ? fmt::format("{} bytes are too few for a binary STL header and it is "
                              "no ASCII STL (which starts with 'solid')",
                              bytes.size())
                : fmt::format("truncated or damaged binary STL: its header announces {} "
                              "triangles, which is {} bytes, but the file has {}",
                              count, expected, bytes.size()));
    bool ended = false;
    for (std::size_t line = 1; !bytes.empty(); ++line) {
        std::string_view rest = take_line(bytes);
        const std::string_view word = take_token(rest);
        if (word == "vertex")
            for (int axis = 0; axis < 3; ++axis)
                coordinate(take_token(rest), line, not_finite);
        ended = word == "endsolid" || (ended && word.empty());
    }
    if (!ended)
        throw MeshError("truncated ASCII STL: it does not end with 'endsolid'");
}

} // namespace boxwood
