// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_LEAF_BOUNDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_LEAF_BOUNDS_INL_H
#undef BOXWOOD_LEAF_BOUNDS_INL_H
#else
#define BOXWOOD_LEAF_BOUNDS_INL_H
#endif

#include <hwy/highway.h>

#include "trees/world/detail/leaf_lanes-inl.h"
#include "trees/world/detail/obb_lanes-inl.h"

#include <algorithm>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// Unit normals of triangles side by side, or shorter ones where they are degenerate, and how far
/// the triangle itself reaches along its normal.
struct alignas(64) NearNormals {
    float normal[3][8], low[8], high[8];

    HWY_INLINE explicit NearNormals(const NearCorners& near) {
        for (std::size_t i = 0; i < 8; i += hn::Lanes(d8)) {
            F8 p[3][3];
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    p[k][axis] = hn::Load(d8, near.corner[k][axis] + i);
            F8 e[3], f[3], n[3];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                e[axis] = hn::Sub(p[1][axis], p[0][axis]);
                f[axis] = hn::Sub(p[2][axis], p[0][axis]);
            }
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
                n[axis] = hn::Sub(hn::Mul(e[y], f[z]), hn::Mul(e[z], f[y]));
            }
            const F8 squared = dot(n, n);
            // Below 1 whatever the rounding; where squares underflow, much below.
            const F8 scale = hn::Div(hn::Set(d8, 1 - 0x1p-20f),
                                     hn::Sqrt(hn::Max(squared, hn::Set(d8, 0x1p-120f))));
            for (std::size_t axis = 0; axis < 3; ++axis) {
                n[axis] = hn::Mul(n[axis], scale);
                hn::Store(n[axis], d8, normal[axis] + i);
            }
            const F8 h0 = dot(n, p[0]), h1 = dot(n, p[1]), h2 = dot(n, p[2]);
            hn::Store(hn::Min(hn::Min(h0, h1), h2), d8, low + i);
            hn::Store(hn::Max(hn::Max(h0, h1), h2), d8, high + i);
        }
    }
    static HWY_INLINE F8 dot(const F8 (&n)[3], const F8 (&p)[3]) {
        return dot3(n[0], n[1], n[2], p[0], p[1], p[2]);
    }
};

/// How far two leaves' triangles reach towards each other along the way from A's centre, which they
/// are seen from, to the middle of B's first triangle.
struct alignas(64) Heights {
    float high_a[8], low_b[8];

    HWY_INLINE Heights(const NearCorners& near_a, const NearCorners& near_b) {
        float way[3], squared = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            way[axis] =
                near_b.corner[0][axis][0] + near_b.corner[1][axis][0] + near_b.corner[2][axis][0];
            squared += way[axis] * way[axis];
        }
        const float scale = (1 - 0x1p-20f) / std::sqrt(std::max(squared, 0x1p-120f));
        const F8 n[3] = {hn::Set(d8, way[0] * scale), hn::Set(d8, way[1] * scale),
                         hn::Set(d8, way[2] * scale)};
        for (std::size_t i = 0; i < 8; i += hn::Lanes(d8)) {
            F8 a[3], b[3];
            for (std::size_t k = 0; k < 3; ++k) {
                a[k] = NearNormals::dot(n, load3(near_a.corner[k], i).of);
                b[k] = NearNormals::dot(n, load3(near_b.corner[k], i).of);
            }
            hn::Store(hn::Max(hn::Max(a[0], a[1]), a[2]), d8, high_a + i);
            hn::Store(hn::Min(hn::Min(b[0], b[1]), b[2]), d8, low_b + i);
        }
    }

  private:
    struct Point {
        F8 of[3];
    };
    static HWY_INLINE Point load3(const float (&rows)[3][8], std::size_t i) {
        return {{hn::Load(d8, rows[0] + i), hn::Load(d8, rows[1] + i), hn::Load(d8, rows[2] + i)}};
    }
};

/// The greatest |coordinate| of eight triangles.
HWY_INLINE float greatest_size(const NearBoxes& boxes) {
    F8 size = hn::Zero(d8);
    for (std::size_t i = 0; i < 8; i += hn::Lanes(d8))
        for (std::size_t axis = 0; axis < 3; ++axis)
            size = hn::Max(size, hn::Max(hn::Abs(hn::Load(d8, boxes.low[axis] + i)),
                                         hn::Abs(hn::Load(d8, boxes.high[axis] + i))));
    return hn::GetLane(hn::MaxOfLanes(d8, size));
}

template <bool greatest>
HWY_INLINE F8 extreme_height(const TriangleLeaf& leaf, const Vec3<double>& way) {
    const F8 n[3] = {hn::Set(d8, static_cast<float>(way.x)), hn::Set(d8, static_cast<float>(way.y)),
                     hn::Set(d8, static_cast<float>(way.z))};
    F8 best = hn::Set(d8, greatest ? -0x1p100f : 0x1p100f);
    for (std::size_t i = 0; i < 8; i += hn::Lanes(d8))
        for (std::size_t k = 0; k < 3; ++k) {
            const F8 p[3] = {hn::Load(d8, leaf.corner[k][0] + i),
                             hn::Load(d8, leaf.corner[k][1] + i),
                             hn::Load(d8, leaf.corner[k][2] + i)};
            const F8 h = NearNormals::dot(n, p);
            best = greatest ? hn::Max(best, h) : hn::Min(best, h);
        }
    return best;
}

/// A bound of the distance of two leaves: the gap of their corners along the way between their
/// centres. A corner's height, in the frame of its mesh, has 3 roundings and is off by less
/// than 4u |corner|_1, and so much more as the way in B's frame is rounded.
HWY_INLINE double gap_of_corners(const TriangleLeaf& a, const TriangleLeaf& b,
                                 const PairFrame& frame) {
    const Vec3<double> t = frame.between(a.own.centre, b.own.centre);
    const double squared = boxwood::dot(t, t);
    if (!(squared > 0x1p-200))
        return 0;
    const Vec3<double> n = (1 / std::sqrt(squared)) * t;
    const auto& r = frame.pose.rotation;
    const Vec3<double> m = n.x * r[0] + n.y * r[1] + n.z * r[2]; // in B's frame
    const F8 high = extreme_height<true>(a, n), low = extreme_height<false>(b, m);
    const double gap =
        boxwood::dot(n, frame.pose.translation) + (double{hn::GetLane(hn::MinOfLanes(d8, low))} -
                                                   double{hn::GetLane(hn::MaxOfLanes(d8, high))});
    return gap * (1 - 0x1p-48) - frame.corners;
}
/// Two leaves in A's frame, seen from A's centre, and bounds of the distances of their triangles.
class LeafPair {
  public:
    HWY_INLINE LeafPair(const TriangleLeaf& a, const TriangleLeaf& b, const PairFrame& frame)
        : moved_(b, frame.pose), near_a_(a, a.own.centre), near_b_(moved_, a.own.centre),
          boxes_a_(near_a_), boxes_b_(near_b_), normals_a_(near_a_), normals_b_(near_b_),
          heights_(near_a_, near_b_) {
        // With c the greatest coordinate: corners are off by uc each; a height along a direction of
        // length 1 at most by sqrt(3) uc, and by as much for each of its 3 roundings; the gap of
        // two by 14uc. 2^-20 = 16u.
        error_ = static_cast<float>(
            0x1p-20 * double{std::max(greatest_size(boxes_a_), greatest_size(boxes_b_))} +
            frame.moved + 0x1p-60);
    }
    const MovedLeaf& moved() const { return moved_; }

    /// Bounds of the distances of triangle i of A and all of B: by their boxes, along the way
    /// between their middles, and along the normals of both. Bits of those that are near enough;
    /// the bounds of others may be left unwritten.
    HWY_INLINE std::uint32_t bound_triangles(std::size_t i, float wanted_distance,
                                             float* bounds) const {
        std::uint32_t bits = 0;
        const F8 zero = hn::Zero(d8), wanted = hn::Set(d8, wanted_distance);
        for (std::size_t lane = 0; lane < 8; lane += hn::Lanes(d8)) {
            F8 squared = zero;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const F8 above = hn::Sub(hn::Load(d8, boxes_b_.low[axis] + lane),
                                         hn::Set(d8, boxes_a_.high[axis][i]));
                const F8 below = hn::Sub(hn::Set(d8, boxes_a_.low[axis][i]),
                                         hn::Load(d8, boxes_b_.high[axis] + lane));
                const F8 gap = hn::Max(hn::Max(above, below), zero);
                squared = hn::MulAdd(gap, gap, squared);
            }
            F8 bound = hn::Max(hn::Sqrt(squared), hn::Sub(hn::Load(d8, heights_.low_b + lane),
                                                          hn::Set(d8, heights_.high_a[i])));
            const auto less_error = [&](F8 x) HWY_ATTR {
                return hn::Sub(hn::Mul(x, hn::Set(d8, 1 - 0x1p-20f)), hn::Set(d8, error_));
            };
            if (hn::AllFalse(d8, hn::Lt(less_error(bound), wanted)))
                continue;
            // Along A's normal.
            const F8 n[3] = {hn::Set(d8, normals_a_.normal[0][i]),
                             hn::Set(d8, normals_a_.normal[1][i]),
                             hn::Set(d8, normals_a_.normal[2][i])};
            F8 h[3];
            for (std::size_t k = 0; k < 3; ++k) {
                const F8 p[3] = {hn::Load(d8, near_b_.corner[k][0] + lane),
                                 hn::Load(d8, near_b_.corner[k][1] + lane),
                                 hn::Load(d8, near_b_.corner[k][2] + lane)};
                h[k] = NearNormals::dot(n, p);
            }
            const F8 low = hn::Min(hn::Min(h[0], h[1]), h[2]);
            const F8 high = hn::Max(hn::Max(h[0], h[1]), h[2]);
            bound = hn::Max(bound, hn::Max(hn::Sub(low, hn::Set(d8, normals_a_.high[i])),
                                           hn::Sub(hn::Set(d8, normals_a_.low[i]), high)));
            // Along B's.
            const F8 m[3] = {hn::Load(d8, normals_b_.normal[0] + lane),
                             hn::Load(d8, normals_b_.normal[1] + lane),
                             hn::Load(d8, normals_b_.normal[2] + lane)};
            for (std::size_t k = 0; k < 3; ++k) {
                const F8 p[3] = {hn::Set(d8, near_a_.corner[k][0][i]),
                                 hn::Set(d8, near_a_.corner[k][1][i]),
                                 hn::Set(d8, near_a_.corner[k][2][i])};
                h[k] = NearNormals::dot(m, p);
            }
            const F8 low_a = hn::Min(hn::Min(h[0], h[1]), h[2]);
            const F8 high_a = hn::Max(hn::Max(h[0], h[1]), h[2]);
            bound = hn::Max(bound, hn::Max(hn::Sub(low_a, hn::Load(d8, normals_b_.high + lane)),
                                           hn::Sub(hn::Load(d8, normals_b_.low + lane), high_a)));
            bound = less_error(bound);
            hn::Store(bound, d8, bounds + lane);
            std::uint8_t part[8] = {};
            hn::StoreMaskBits(d8, hn::Lt(bound, wanted), part);
            bits |= static_cast<std::uint32_t>(part[0]) << lane;
        }
        return bits;
    }

  private:
    MovedLeaf moved_;
    NearCorners near_a_, near_b_;
    NearBoxes boxes_a_, boxes_b_;
    NearNormals normals_a_, normals_b_;
    Heights heights_;
    float error_;
};

/// Bounds of the distances of eight pairs of triangles: the gap along any direction n is one, min
/// n.b - max n.a over the corners, over |n|. Of a unit vector n each of the two sums of products is
/// off by less than 7 2^-53 times the greatest |coordinate|, both by less than half of `moved`.
HWY_INLINE void gaps_along(const double (&way)[3][8], const TrianglePairBlock<double>& pairs,
                           double moved, double (&gaps)[8]) {
    const hn::CappedTag<double, 8> d;
    using D8 = hn::Vec<decltype(d)>;
    for (std::size_t i = 0; i < 8; i += hn::Lanes(d)) {
        const D8 n[3] = {hn::Load(d, way[0] + i), hn::Load(d, way[1] + i), hn::Load(d, way[2] + i)};
        const auto heights = [&](int side, bool least) HWY_ATTR {
            D8 h[3];
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& corner = pairs.corner[side][k];
                h[k] = hn::Add(hn::Add(hn::Mul(n[0], hn::Load(d, corner[0] + i)),
                                       hn::Mul(n[1], hn::Load(d, corner[1] + i))),
                               hn::Mul(n[2], hn::Load(d, corner[2] + i)));
            }
            return least ? hn::Min(hn::Min(h[0], h[1]), h[2]) : hn::Max(hn::Max(h[0], h[1]), h[2]);
        };
        const D8 gap = hn::Sub(heights(1, true), heights(0, false));
        const D8 length = hn::Sqrt(
            hn::Add(hn::Add(hn::Mul(n[0], n[0]), hn::Mul(n[1], n[1])), hn::Mul(n[2], n[2])));
        const D8 bound = hn::Sub(
            hn::Mul(hn::Div(gap, hn::Max(length, hn::Set(d, 1e-150))), hn::Set(d, 1 - 0x1p-48)),
            hn::Set(d, moved));
        hn::Store(bound, d, gaps + i);
    }
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
