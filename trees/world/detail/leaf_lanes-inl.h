// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_LEAF_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_LEAF_LANES_INL_H
#undef BOXWOOD_LEAF_LANES_INL_H
#else
#define BOXWOOD_LEAF_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/triangle_triangle/triangle_kernel.h"
#include "trees/queries/sinks.h"
#include "trees/world/detail/pair_frame.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The corners of a leaf of B in A's frame, as Pose moves each: by corner, axis and lane.
struct alignas(64) MovedLeaf {
    double corner[3][3][8];

    HWY_INLINE MovedLeaf(const TriangleLeaf& leaf, const Pose& pose) {
        const hn::CappedTag<double, 8> d;
        const hn::Rebind<float, decltype(d)> df;
        for (std::size_t i = 0; i < 8; i += hn::Lanes(d))
            for (std::size_t k = 0; k < 3; ++k) {
                const auto x = hn::PromoteTo(d, hn::Load(df, leaf.corner[k][0] + i));
                const auto y = hn::PromoteTo(d, hn::Load(df, leaf.corner[k][1] + i));
                const auto z = hn::PromoteTo(d, hn::Load(df, leaf.corner[k][2] + i));
                for (std::size_t row = 0; row < 3; ++row) {
                    const Vec3<double>& r = pose.rotation[row];
                    const auto turned =
                        hn::Add(hn::Add(hn::Mul(hn::Set(d, r.x), x), hn::Mul(hn::Set(d, r.y), y)),
                                hn::Mul(hn::Set(d, r.z), z));
                    hn::Store(hn::Add(turned, hn::Set(d, pose.translation[static_cast<int>(row)])),
                              d, corner[k][row] + i);
                }
            }
    }
};

/// Corners seen from a point, rounded to floats: in one leaf as in another the roundings are
/// monotone, so that boxes which are apart in floats are apart.
struct alignas(64) NearCorners {
    float corner[3][3][8];

    HWY_INLINE NearCorners(const MovedLeaf& leaf, const double (&from)[3]) {
        const hn::CappedTag<double, 8> d;
        const hn::Rebind<float, decltype(d)> df;
        for (std::size_t i = 0; i < 8; i += hn::Lanes(d))
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    hn::Store(hn::DemoteTo(df, hn::Sub(hn::Load(d, leaf.corner[k][axis] + i),
                                                       hn::Set(d, from[axis]))),
                              df, corner[k][axis] + i);
    }
    HWY_INLINE NearCorners(const TriangleLeaf& leaf, const double (&from)[3]) {
        const hn::CappedTag<double, 8> d;
        const hn::Rebind<float, decltype(d)> df;
        for (std::size_t i = 0; i < 8; i += hn::Lanes(d))
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    hn::Store(
                        hn::DemoteTo(
                            df, hn::Sub(hn::PromoteTo(d, hn::Load(df, leaf.corner[k][axis] + i)),
                                        hn::Set(d, from[axis]))),
                        df, corner[k][axis] + i);
    }
};

/// The boxes of such triangles: least and greatest by axis.
struct alignas(64) NearBoxes {
    float low[3][8], high[3][8];

    HWY_INLINE explicit NearBoxes(const NearCorners& near) {
        const hn::CappedTag<float, 8> d;
        for (std::size_t i = 0; i < 8; i += hn::Lanes(d))
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto a = hn::Load(d, near.corner[0][axis] + i);
                const auto b = hn::Load(d, near.corner[1][axis] + i);
                const auto c = hn::Load(d, near.corner[2][axis] + i);
                hn::Store(hn::Min(hn::Min(a, b), c), d, low[axis] + i);
                hn::Store(hn::Max(hn::Max(a, b), c), d, high[axis] + i);
            }
    }
};

/// Pairs of triangles, one of A's leaf and one of B's, gathered into blocks for a batch kernel.
template <std::size_t capacity> class PairBlocks {
  public:
    static constexpr std::size_t lanes = TrianglePairBlock<double>::lanes;

    std::size_t size() const { return n_; }
    bool has_room_for(std::size_t n) const { return n_ + n <= capacity; }
    void clear() { n_ = 0; }
    HWY_INLINE void add(const TriangleLeaf& a, std::size_t i, const TriangleLeaf& b,
                        const MovedLeaf& moved, std::size_t j) {
        auto& [rows_a, rows_b] = blocks_[n_ / lanes].corner;
        const std::size_t lane = n_ % lanes;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                rows_a[k][axis][lane] = double{a.corner[k][axis][i]};
                rows_b[k][axis][lane] = moved.corner[k][axis][j];
            }
        triangles_[n_++] = {a.triangle[i], b.triangle[j]};
    }
    std::span<const TrianglePairBlock<double>> blocks() const {
        return {blocks_, (n_ + lanes - 1) / lanes};
    }
    /// Lanes behind the last pair are read: they repeat the first.
    void pad() {
        for (std::size_t lane = n_ % lanes; lane != 0 && lane < lanes; ++lane) {
            TrianglePairBlock<double>& block = blocks_[n_ / lanes];
            for (auto& side : block.corner)
                for (auto& corner : side)
                    for (auto& row : corner)
                        row[lane] = row[0];
        }
    }
    const Pair& triangles(std::size_t i) const { return triangles_[i]; }
    Triangle<double> triangle(int side, std::size_t i) const {
        return blocks_[i / lanes].triangle(side, i % lanes);
    }

  private:
    static_assert(capacity % lanes == 0);
    TrianglePairBlock<double> blocks_[capacity / lanes]; // not cleared
    Pair triangles_[capacity];
    std::size_t n_ = 0;
};

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
