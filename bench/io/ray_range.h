#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

namespace boxwood::bench {

/// The first vertex of a mesh that rays cannot be aimed at, if there is one.
inline std::optional<std::size_t> beyond_ray_range(const TriangleMesh& mesh) {
    const auto found = std::ranges::find_if(mesh.vertices, [](Vec3<float> p) {
        return !(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < max_ray_coordinate);
    });
    if (found == mesh.vertices.end())
        return std::nullopt;
    return static_cast<std::size_t>(found - mesh.vertices.begin());
}

/// Why not.
inline std::string out_of_ray_range(const TriangleMesh& mesh, std::size_t vertex) {
    const Vec3<float> p = mesh.vertices[vertex];
    return fmt::format("has a vertex at ({}, {}, {}); rays need coordinates below 2^126 (8.5e37) "
                       "in size: scale the mesh",
                       p.x, p.y, p.z);
}

} // namespace boxwood::bench
