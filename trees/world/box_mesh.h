#pragma once

#include "kernels/primitives/triangle.h"

#include <array>

namespace boxwood {

/// The surface of a box about the origin, of 12 triangles wound outwards. sides: full lengths,
/// whose halves are rounded to floats.
inline TriangleMesh box_mesh(const Vec3<double>& sides) {
    const Vec3<float> half(0.5 * sides);
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.vertices.push_back({corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y,
                                 corner & 4 ? half.z : -half.z});
    constexpr std::array<std::array<std::uint32_t, 4>, 6> faces{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& [a, b, c, d] : faces) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    }
    return mesh;
}

} // namespace boxwood
