#pragma once

#include "kernels/primitives/triangle.h"
#include "scenes/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

/// A subdivided octahedron, blown up: what generators of sphere-like surfaces share.
namespace boxwood {

/// The points with integer coordinates and |x| + |y| + |z| = f, numbered ring by ring from the top
/// (z = f): 4 r points in the ring of radius r = f - |z|, one at each pole, 4 f^2 + 2 in all.
struct OctahedronGrid {
    std::int64_t f;

    std::uint32_t index(std::int64_t x, std::int64_t y, std::int64_t z) const {
        const std::int64_t r = f - std::abs(z);
        // Before the ring of radius r > 0 of the upper half: the pole and 4 (1 + ... + (r - 1)).
        const std::int64_t total = 4 * f * f + 2;
        if (r == 0)
            return static_cast<std::uint32_t>(z > 0 ? 0 : total - 1);
        const std::int64_t ring = z >= 0 ? 1 + 2 * r * (r - 1) : total - 1 - 2 * r * (r + 1);
        const std::int64_t place = x > 0 && y >= 0   ? y
                                   : y > 0 && x <= 0 ? r - x
                                   : x < 0 && y <= 0 ? 2 * r - y
                                                     : 3 * r + x;
        return static_cast<std::uint32_t>(ring + place);
    }
};

/// The vertices (those on the octant's rim again, to the same value) and the f^2 triangles.
template <class Place>
void add_octant(TriangleMesh& mesh, OctahedronGrid grid, int octant, const Place& place) {
    const std::int64_t f = grid.f;
    const std::int64_t sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
    const bool mirrored = sx * sy * sz < 0;
    const auto at = [&](std::int64_t x, std::int64_t y) {
        return grid.index(sx * x, sy * y, sz * (f - x - y));
    };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh.triangles.push_back(mirrored ? std::array{a, c, b} : std::array{a, b, c});
    };
    for (std::int64_t x = 0; x <= f; ++x)
        for (std::int64_t y = 0; x + y <= f; ++y) {
            const Vec3<double> p{static_cast<double>(sx * x), static_cast<double>(sy * y),
                                 static_cast<double>(sz * (f - x - y))};
            mesh.vertices[at(x, y)] = static_cast<Vec3<float>>(place(p * (1 / length(p))));
            if (x + y < f)
                add(at(x, y), at(x + 1, y), at(x, y + 1));
            if (x + y + 1 < f)
                add(at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
        }
}

/// f of the 8 f^2 triangles nearest to the wanted number. Throws std::invalid_argument for 0 of
/// them or more than can be numbered.
inline std::int64_t subdivision_of(const SceneSpec& spec, std::string_view scene) {
    if (spec.n == 0 || spec.n > 0x7fffffff)
        throw std::invalid_argument(
            fmt::format("scene {}: n = {} triangles must lie in [1, 2147483647]", scene, spec.n));
    const double wanted = std::sqrt(static_cast<double>(spec.n) / 8);
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(wanted + 0.5));
}

/// A closed surface of 8 f^2 triangles that wind counter-clockwise seen from outside; `place` says
/// where a direction's vertex stands.
template <class Place> TriangleMesh octahedron_sphere(std::int64_t f, const Place& place) {
    TriangleMesh mesh;
    mesh.vertices.resize(static_cast<std::size_t>(4 * f * f + 2));
    mesh.triangles.reserve(static_cast<std::size_t>(8 * f * f));
    for (int octant = 0; octant < 8; ++octant)
        add_octant(mesh, OctahedronGrid{f}, octant, place);
    return mesh;
}

} // namespace boxwood
