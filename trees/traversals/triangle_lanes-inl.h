// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_TRIANGLE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_TRIANGLE_LANES_INL_H
#undef BOXWOOD_TRIANGLE_LANES_INL_H
#else
#define BOXWOOD_TRIANGLE_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "kernels/primitives/triangle.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// Up to 16 triangles side by side, seen from a point: corner a, and the edges from a to b and c,
/// all times a power of two. Edges are differences of corners, so that they are off by their own
/// rounding alone, however far the point is.
struct alignas(64) SeenTriangles {
    static constexpr std::size_t most = 16;
    float a[3][most], ab[3][most], ac[3][most];

    void Set(std::size_t lane, const Triangle<float>& t, Vec3<float> point, float scale) {
        for (int axis = 0; axis < 3; ++axis) {
            a[axis][lane] = (t.a[axis] - point[axis]) * scale;
            ab[axis][lane] = (t.b[axis] - t.a[axis]) * scale;
            ac[axis][lane] = (t.c[axis] - t.a[axis]) * scale;
        }
    }
};

template <class D> struct Lanes3 { hwy::HWY_NAMESPACE::Vec<D> x, y, z; };

template <class D> HWY_INLINE Lanes3<D> Load3(D d, const float (*from)[16], std::size_t i) {
    namespace hn = hwy::HWY_NAMESPACE;
    return {hn::Load(d, from[0] + i), hn::Load(d, from[1] + i), hn::Load(d, from[2] + i)};
}
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> Dot(const Lanes3<D>& a, const Lanes3<D>& b) {
    namespace hn = hwy::HWY_NAMESPACE;
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
template <class D> HWY_INLINE Lanes3<D> Cross(const Lanes3<D>& a, const Lanes3<D>& b) {
    namespace hn = hwy::HWY_NAMESPACE;
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

/// The squared distance from the origin to the segments from a along e.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> SegmentSquared(D d, const Lanes3<D>& a, const Lanes3<D>& e) {
    namespace hn = hwy::HWY_NAMESPACE;
    const auto ee = hn::Max(Dot<D>(e, e), hn::Set(d, std::numeric_limits<float>::min()));
    const auto t =
        hn::Min(hn::Max(hn::Div(hn::Neg(Dot<D>(a, e)), ee), hn::Zero(d)), hn::Set(d, 1.0f));
    const Lanes3<D> q{hn::MulAdd(t, e.x, a.x), hn::MulAdd(t, e.y, a.y), hn::MulAdd(t, e.z, a.z)};
    return Dot<D>(q, q);
}

/// Bounds from below of the squared distances to triangles [i, i + Lanes(d)), scaled.
/// Where the sine of the angle at a is above 2^-6, normal and foot are off by a few 2^-24 / sine of
/// the farthest corner's distance; a distance is taken smaller by 2^-13 of that, over ten times as
/// much. Of other triangles, and where something overflows, the bound is 0.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> TriangleBounds(D d, const SeenTriangles& seen,
                                                     std::size_t i) {
    namespace hn = hwy::HWY_NAMESPACE;
    const Lanes3<D> a = Load3(d, seen.a, i), ab = Load3(d, seen.ab, i), ac = Load3(d, seen.ac, i);
    const Lanes3<D> b{hn::Add(a.x, ab.x), hn::Add(a.y, ab.y), hn::Add(a.z, ab.z)};
    const Lanes3<D> bc{hn::Sub(ac.x, ab.x), hn::Sub(ac.y, ab.y), hn::Sub(ac.z, ab.z)};
    const auto edges = hn::Min(hn::Min(SegmentSquared(d, a, ab), SegmentSquared(d, a, ac)),
                               SegmentSquared(d, b, bc));
    const Lanes3<D> n = Cross<D>(ab, ac);
    const auto nn = Dot<D>(n, n);
    // The foot in the plane is at a + v ab + w ac, here times nn; seen from a the point is at -a.
    const auto v = Dot<D>(Cross<D>(ac, a), n), w = Dot<D>(Cross<D>(a, ab), n);
    const auto inside =
        hn::And(hn::And(hn::Ge(v, hn::Zero(d)), hn::Ge(w, hn::Zero(d))), hn::Le(hn::Add(v, w), nn));
    const auto height = Dot<D>(n, a);
    const auto plane = hn::Div(hn::Mul(height, height), nn);
    const auto squared = hn::IfThenElse(inside, hn::Min(plane, edges), edges);

    const auto abab = Dot<D>(ab, ab), acac = Dot<D>(ac, ac);
    const auto size = hn::Add(Dot<D>(a, a), hn::Add(abab, acac));
    const auto slack = hn::Mul(hn::Set(d, 0x1p-12f), hn::Sqrt(hn::Mul(squared, size)));
    const auto bound = hn::Sub(squared, slack);
    const auto sure = hn::And(hn::Gt(nn, hn::Mul(hn::Set(d, 0x1p-12f), hn::Mul(abab, acac))),
                              hn::Lt(hn::Mul(size, size), hn::Set(d, 0x1p60f)));
    return hn::IfThenElseZero(sure, hn::Max(bound, hn::Zero(d)));
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
