#pragma once

#include "bench/io/bad_input.h"
#include "kernels/convex/shapes.h"
#include "kernels/primitives/triangle.h"
#include "trees/world/pose.h"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <string>

namespace boxwood::bench {

/// What a query takes as a body, for its help.
inline constexpr const char* body_forms =
    "a mesh file (OBJ, PLY, STL, ...), or box:x,y,z, sphere:radius, capsule:radius,length, "
    "cylinder:radius,length. A mesh is its surface, and so is a box beside a mesh or a box; what "
    "is "
    "round, and a box beside it, is solid";

/// A primitive in the place of a mesh file: "box:x,y,z" (full side lengths), "sphere:radius",
/// "capsule:radius,length" (of its segment, without the round ends), "cylinder:radius,length", the
/// last two along z. Nothing of other texts. Throws BadInput for numbers that make no sense.
std::optional<convex::Shape> read_primitive(const std::string& text);

/// The triangles of a mesh file, or of a box. Throws BadInput, and as load_mesh.
TriangleMesh read_body(const std::string& body);

/// How far the corners of a box's triangles are off, as floats, rounded up; 0 of other shapes.
double rounding_of_mesh(const convex::Shape& shape);

/// 16 numbers, row by row, parted by spaces or commas; the identity if empty. Throws BadInput,
/// which names the option.
Pose read_pose(const std::string& text, const std::string& option);

/// make(), with the name of the body before what is wrong with it.
template <class Make> auto named(const std::string& body, const Make& make) {
    try {
        return make();
    } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format("{}: {}", body, error.what()));
    }
}

} // namespace boxwood::bench
