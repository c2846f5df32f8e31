#pragma once

#include "bench/commands/queries/query_times.h"
#include "bench/commands/queries/user_mesh.h"
#include "bench/io/bad_input.h"
#include "kernels/convex/shapes.h"
#include "trees/world/bodies/body_shape.h"
#include "trees/world/pose.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What a query takes as a body: in a line, and one form a line for the end of its help.
inline constexpr const char* body_form = "a mesh file, box:1,1,1, sphere:.5, or what is below";
std::string body_forms();

/// How bodies are read.
struct BodyReading {
    bool is_solid = false; ///< closed meshes are solids
    BadTriangles bad_triangles = BadTriangles::keep;
    MeshVolume volume = MeshVolume::obb; ///< of the trees of meshes
    QueryTimes* times = nullptr;         ///< has what it took, if given
};

/// A body as it was written, in the place of a mesh file: see body_forms.
struct NamedBody {
    BodyShape shape;
    /// A box whose 12 triangles the shape is.
    std::optional<convex::Box> box{};
    std::vector<std::uint32_t> numbers{}; ///< UserMesh::numbers

    bool has_triangles() const { return shape.shape_class() != ShapeClass::convex; }
};

/// Whether a box beside this body is its surface: a mesh file, a height field or another box.
bool is_surface_form(const std::string& text);

/// Reads and builds it. box_is_surface: a box is 12 triangles, else a convex shape. Throws BadInput
/// for numbers that make no sense, for a mesh that is no solid and should be one, and as load_mesh.
NamedBody read_body(const std::string& text, bool box_is_surface, const BodyReading& how);

/// The option --volume, by the names of `mesh_volumes`.
void add_volume_option(CLI::App& app, MeshVolume& volume);

/// How far the corners of a box's triangles are off, as floats, rounded up.
double rounding_of_mesh(const convex::Box& box);

/// 16 numbers, row by row, parted by spaces or commas; the identity if empty. Throws BadInput,
/// which names the option.
Pose read_pose(const std::string& text, const std::string& option);
/// The same, or x,y,z alone; not empty.
Pose read_place(const std::string& text, const std::string& option);

} // namespace boxwood::bench
