// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_TRIANGLE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_TRIANGLE_LANES_INL_H
#undef BOXWOOD_TRIANGLE_LANES_INL_H
#else
#define BOXWOOD_TRIANGLE_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/primitives/triangle.h"
#include "kernels/simd/vec3-inl.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// Up to 16 triangles side by side, seen from a point: corner a, and the edges from a to b and c,
/// all times a power of two. Edges are differences of corners, so that they are off by their own
/// rounding alone, however far the point is.
struct alignas(64) SeenTriangles {
    static constexpr std::size_t max = 16;
    float a[3][max], ab[3][max], ac[3][max];

    void set(std::size_t lane, const Triangle<float>& t, Vec3<float> point, float scale) {
        for (int axis = 0; axis < 3; ++axis) {
            a[axis][lane] = (t.a[axis] - point[axis]) * scale;
            ab[axis][lane] = (t.b[axis] - t.a[axis]) * scale;
            ac[axis][lane] = (t.c[axis] - t.a[axis]) * scale;
        }
    }
};

using boxwood::HWY_NAMESPACE::load3;
template <class D> using Lanes3 = boxwood::HWY_NAMESPACE::LaneVec3<hwy::HWY_NAMESPACE::Vec<D>>;

/// The squared distance from the origin to the segments from a along e.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> segment_squared(D d, const Lanes3<D>& a, const Lanes3<D>& e) {
    namespace hn = hwy::HWY_NAMESPACE;
    const auto ee = hn::Max(fused_dot(e, e), hn::Set(d, std::numeric_limits<float>::min()));
    const auto t =
        hn::Min(hn::Max(hn::Div(hn::Neg(fused_dot(a, e)), ee), hn::Zero(d)), hn::Set(d, 1.0f));
    const Lanes3<D> q{hn::MulAdd(t, e.x, a.x), hn::MulAdd(t, e.y, a.y), hn::MulAdd(t, e.z, a.z)};
    return fused_dot(q, q);
}

/// Bounds from below of the squared distances to triangles [i, i + Lanes(d)), scaled.
/// Where the sine of the angle at a is above 2^-6, normal and foot are off by a few 2^-24 / sine of
/// the farthest corner's distance; a distance is taken smaller by 2^-13 of that, over ten times as
/// much. Of other triangles, and where something overflows, the bound is 0.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> triangle_bounds(D d, const SeenTriangles& seen,
                                                      std::size_t i) {
    namespace hn = hwy::HWY_NAMESPACE;
    const Lanes3<D> a = load3(d, seen.a, i), ab = load3(d, seen.ab, i), ac = load3(d, seen.ac, i);
    const Lanes3<D> b = a + ab, bc = ac - ab;
    const auto edges = hn::Min(hn::Min(segment_squared(d, a, ab), segment_squared(d, a, ac)),
                               segment_squared(d, b, bc));
    const Lanes3<D> n = fused_cross(ab, ac);
    const auto nn = fused_dot(n, n);
    // The foot in the plane is at a + v ab + w ac, here times nn; seen from a the point is at -a.
    const auto v = fused_dot(fused_cross(ac, a), n), w = fused_dot(fused_cross(a, ab), n);
    const auto inside =
        hn::And(hn::And(hn::Ge(v, hn::Zero(d)), hn::Ge(w, hn::Zero(d))), hn::Le(hn::Add(v, w), nn));
    const auto height = fused_dot(n, a);
    const auto plane = hn::Div(hn::Mul(height, height), nn);
    const auto squared = hn::IfThenElse(inside, hn::Min(plane, edges), edges);

    const auto abab = fused_dot(ab, ab), acac = fused_dot(ac, ac);
    const auto size = hn::Add(fused_dot(a, a), hn::Add(abab, acac));
    const auto slack = hn::Mul(hn::Set(d, 0x1p-12f), hn::Sqrt(hn::Mul(squared, size)));
    const auto bound = hn::Sub(squared, slack);
    const auto sure = hn::And(hn::Gt(nn, hn::Mul(hn::Set(d, 0x1p-12f), hn::Mul(abab, acac))),
                              hn::Lt(hn::Mul(size, size), hn::Set(d, 0x1p60f)));
    return hn::IfThenElseZero(sure, hn::Max(bound, hn::Zero(d)));
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
