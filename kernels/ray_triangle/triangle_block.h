#pragma once

#include "kernels/primitives/triangle.h"

#include <cstddef>
#include <cstdint>

namespace boxwood {

/// Triangles side by side for SIMD, 40 bytes each: `lanes` is 4 or 8. Unused lanes repeat lane 0.
template <std::size_t lanes_> struct alignas(8 * lanes_) TriangleBlock {
    static constexpr std::size_t lanes = lanes_;
    float corner[3][3][lanes]; ///< by corner, axis and lane
    std::uint32_t id[lanes];   ///< triangle of the mesh

    void set(std::size_t lane, const Triangle<float>& t, std::uint32_t triangle_id) {
        for (int axis = 0; axis < 3; ++axis) {
            corner[0][axis][lane] = t.a[axis];
            corner[1][axis][lane] = t.b[axis];
            corner[2][axis][lane] = t.c[axis];
        }
        id[lane] = triangle_id;
    }
    Triangle<float> triangle(std::size_t lane) const {
        const auto at = [&](int k) {
            return Vec3<float>{corner[k][0][lane], corner[k][1][lane], corner[k][2][lane]};
        };
        return {at(0), at(1), at(2)};
    }
};
static_assert(sizeof(TriangleBlock<8>) == 320 && sizeof(TriangleBlock<4>) == 160);

/// Where a ray meets the triangles of a block: t, u and v of the lanes that are hit.
template <std::size_t lanes> struct alignas(4 * lanes) BlockHits {
    float t[lanes], u[lanes], v[lanes];
};

} // namespace boxwood
