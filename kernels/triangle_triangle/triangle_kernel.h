#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/triangle.h"

#include <concepts>
#include <cstddef>
#include <span>

namespace boxwood {

/// Whether two closed triangles share a point, with the accuracy that K::info states. K::Real
/// (float or double) is what it reads. Triangles may be degenerate. The answer is `maybe` where the
/// kernel cannot decide, and for NaN.
template <class K>
concept TriangleKernel = DescribedKernel<K> &&
    requires(const Triangle<typename K::Real>& a, const Triangle<typename K::Real>& b) {
    { K::intersect(a, b) } -> std::same_as<Decision>;
};

/// Pairs side by side for SIMD: `lanes` is 16 for float, 8 for double.
template <class Real> struct alignas(64) TrianglePairBlock {
    static constexpr std::size_t lanes = 64 / sizeof(Real);
    Real corner[2][3][3][lanes]; ///< by side, corner, axis and lane

    void set(std::size_t lane, const Triangle<Real>& a, const Triangle<Real>& b) {
        const Triangle<Real>* sides[2] = {&a, &b};
        for (int side = 0; side < 2; ++side)
            for (int axis = 0; axis < 3; ++axis) {
                corner[side][0][axis][lane] = sides[side]->a[axis];
                corner[side][1][axis][lane] = sides[side]->b[axis];
                corner[side][2][axis][lane] = sides[side]->c[axis];
            }
    }
    Triangle<Real> triangle(int side, std::size_t lane) const {
        const auto at = [&](int k) {
            return Vec3<Real>{corner[side][k][0][lane], corner[side][k][1][lane],
                              corner[side][k][2][lane]};
        };
        return {at(0), at(1), at(2)};
    }
};

/// A TriangleKernel that also answers many pairs at a time, the same as one by one.
/// decisions.size() <= blocks.size() * lanes; lanes beyond it are read but not answered.
template <class K>
concept TriangleBatchKernel = TriangleKernel<K> &&
    requires(std::span<const TrianglePairBlock<typename K::Real>> blocks,
             std::span<Decision> decisions) {
    K::intersect(blocks, decisions);
};

} // namespace boxwood
