#include "bench/commands/queries/bodies.h"

#include "bench/io/bad_input.h"
#include "scenes/meshes/mesh_file.h"
#include "scenes/text/csv.h"
#include "trees/world/box_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <stdexcept>

namespace boxwood::bench {
namespace {

/// A primitive in the place of a file: "box:1,1,1", its full side lengths.
std::optional<TriangleMesh> primitive(const std::string& text) {
    constexpr std::array kinds{"box", "sphere", "capsule", "cylinder"};
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    if (colon == std::string::npos || std::ranges::find(kinds, kind) == kinds.end())
        return std::nullopt;
    if (kind != "box")
        throw BadInput(
            fmt::format("{}: of primitives only boxes are answered (box:x,y,z, full side "
                        "lengths); a {} can be given as a mesh file",
                        text, kind));
    Vec3<double> lengths;
    const auto take_sides = [&](std::span<const double> sides, std::size_t) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(sides[axis] >= 0 && sides[axis] < 0x1p60))
                throw BadInput(fmt::format("{}: a side is {}; it must be at least 0 and finite",
                                           text, sides[axis]));
            lengths[static_cast<int>(axis)] = sides[axis];
        }
    };
    if (read_csv(text.substr(colon + 1), text, {"x,y,z, the full side lengths of the box", 3, 3},
                 take_sides) != 1)
        throw BadInput(fmt::format("{}: a box is box:x,y,z, its full side lengths", text));
    return box_mesh(lengths);
}

} // namespace

TriangleMesh read_body(const std::string& body) {
    if (auto mesh = primitive(body))
        return *mesh;
    return load_mesh(body);
}

Pose read_pose(const std::string& text, const std::string& option) {
    if (text.empty())
        return {};
    std::string row;
    for (const char c : text) {
        const bool parts = c == ' ' || c == ',' || c == '\t' || c == '\n';
        if (!parts)
            row += c;
        else if (!row.empty() && row.back() != ',')
            row += ',';
    }
    if (!row.empty() && row.back() == ',')
        row.pop_back();
    Pose pose;
    const auto take_matrix = [&](std::span<const double> m, std::size_t) {
        for (std::size_t i = 0; i < 3; ++i) {
            pose.rotation[i] = {m[4 * i], m[4 * i + 1], m[4 * i + 2]};
            pose.translation[static_cast<int>(i)] = m[4 * i + 3];
        }
        if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
            throw BadInput(fmt::format("{}: the last row is {},{},{},{}; that of a rigid "
                                       "transform is 0,0,0,1 (the numbers go row by row)",
                                       option, m[12], m[13], m[14], m[15]));
    };
    if (read_csv(row, option, {"16 numbers, a 4 x 4 matrix row by row", 16, 16}, take_matrix) == 0)
        throw BadInput(option + " is empty; it takes 16 numbers, a 4 x 4 matrix row by row");
    try {
        return checked_pose(pose);
    } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format("{}: {}", option, error.what()));
    }
}

} // namespace boxwood::bench
