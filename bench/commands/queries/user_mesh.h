#pragma once

#include "kernels/primitives/triangle.h"

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace boxwood::bench {

/// What becomes of triangles that MeshTriage calls bad. keep: those with a number that is not
/// finite are set aside, as nothing can be said of them; the others are points and segments, and
/// repeated.
enum class BadTriangles : std::uint8_t { keep, set_aside, refuse };

/// A mesh of the user's.
struct UserMesh {
    TriangleMesh mesh;
    std::vector<std::uint32_t> numbers{}; ///< of its triangles in the file; empty: all of them

    std::uint32_t number_of(std::uint32_t triangle) const {
        return triangle < numbers.size() ? numbers[triangle] : triangle;
    }
};

/// Of a file that load_mesh reads. What is bad is counted on stderr. is_solid: all bad triangles
/// are set aside, too, where the mesh is closed without them and is not with them. Throws BadInput
/// for bad triangles that are refused and where all are set aside; and as load_mesh.
UserMesh read_user_mesh(const std::string& file, BadTriangles what, bool is_solid);

/// The option --bad-triangles.
void add_bad_triangles_option(CLI::App& app, BadTriangles& what);

} // namespace boxwood::bench
