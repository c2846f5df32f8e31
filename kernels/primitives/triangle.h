#pragma once

#include "kernels/primitives/aabb.h"

#include <array>
#include <cstdint>
#include <vector>

namespace boxwood {

/// A closed triangle: its three corners, edges and inside. It may be degenerate (a segment or
/// point).
template <class Real> struct Triangle {
    Vec3<Real> a, b, c;

    constexpr bool operator==(const Triangle&) const = default;

    BOXWOOD_BOTH constexpr Aabb<Real> bounds() const {
        Aabb<Real> box;
        box.extend(a);
        box.extend(b);
        box.extend(c);
        return box;
    }
};

/// An indexed triangle mesh in floats: triangle i has the corners vertices[triangles[i][0..2]].
struct TriangleMesh {
    std::vector<Vec3<float>> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    Triangle<float> triangle(std::size_t i) const {
        const auto& t = triangles[i];
        return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
    }
};

} // namespace boxwood
