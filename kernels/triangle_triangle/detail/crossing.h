#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/triangle.h"

/// What guigue_devillers_batch.cpp does with a vector of pairs, for one pair in registers: no
/// branch, and no corner chosen by a number. The same operations in the same order, so that the
/// answers are the batch's. Its comments say what each value is, and derive the bound.
namespace boxwood::detail {

template <class Real> struct CrossingBound;
template <> struct CrossingBound<double> {
    static constexpr double min_size = 0x1p-300, bound = 270 * 0x1p-53, headroom = 0x1p400;
};
template <> struct CrossingBound<float> {
    static constexpr float min_size = 0x1p-28f, bound = 270 * 0x1p-24f, headroom = 0x1p48f;
};

template <class Real> BOXWOOD_BOTH Real size_of(Real x) { return x < 0 ? -x : x; }
/// NaN is ignored: it makes no sign certain.
template <class Real>
BOXWOOD_BOTH Real largest_size(Real min_size, Real a, Real b, Real c, Real d, Real e) {
    const Real sizes[5] = {size_of(a), size_of(b), size_of(c), size_of(d), size_of(e)};
    Real all = min_size;
    for (const Real& x : sizes)
        all = all < x ? x : all;
    return all;
}

/// The corner that the other's plane parts from the two others, by the signs of three heights.
struct LoneCorner {
    bool differ01, differ02, differ12, below;

    template <class Real>
    BOXWOOD_BOTH LoneCorner(Real h0, Real h1, Real h2)
        : differ01((h0 < 0) != (h1 < 0)), differ02((h0 < 0) != (h2 < 0)),
          differ12((h1 < 0) != (h2 < 0)), below(differ01 != (h2 < 0)) {}

    BOXWOOD_BOTH bool exists() const { return differ01 || differ02; }
    template <class T> BOXWOOD_BOTH T pick(T v0, T v1, T v2) const {
        return differ01 ? (differ02 ? v0 : v1) : v2;
    }
    template <class T> BOXWOOD_BOTH T next(T v01, T v02, T v12) const {
        return pick(v01, v12, v02);
    }
    template <class T> BOXWOOD_BOTH T last(T v01, T v02, T v12) const {
        return pick(v02, v01, v12);
    }
    BOXWOOD_BOTH bool next_turned() const { return !differ01; }
    BOXWOOD_BOTH bool last_turned() const { return differ12; }
};

/// Yes or no where no sign that matters is near zero. proven: by the bound, else zero itself. Of
/// NaN and infinity: maybe.
template <class Real, bool proven>
BOXWOOD_BOTH Answer crossing(const Triangle<Real>& a, const Triangle<Real>& b) {
    using Vector = Vec3<Real>;
    const Vector a1 = a.b - a.a, a2 = a.c - a.a, b0 = b.a - a.a, b1 = b.b - a.a, b2 = b.c - a.a;
    const Vector normal = cross(a1, a2);
    const Real above_a0 = dot(normal, b0), above_a1 = dot(normal, b1), above_a2 = dot(normal, b2);
    const Vector moment01 = cross(b0, b1), moment02 = cross(b0, b2), moment12 = cross(b1, b2);
    const Real s01_01 = dot(a1, moment01), s01_02 = dot(a1, moment02), s01_12 = dot(a1, moment12);
    const Real s02_01 = dot(a2, moment01), s02_02 = dot(a2, moment02), s02_12 = dot(a2, moment12);
    const Real s12_01 = (s02_01 - s01_01) + (above_a1 - above_a0);
    const Real s12_02 = (s02_02 - s01_02) + (above_a2 - above_a0);
    const Real s12_12 = (s02_12 - s01_12) + (above_a2 - above_a1);
    const Real above_b0 = -dot(b0, moment12);
    const Real above_b1 = ((s01_01 + s01_12) - s01_02) + above_b0;
    const Real above_b2 = ((s02_01 + s02_12) - s02_02) + above_b0;

    Real bound;
    if constexpr (proven) {
        using B = CrossingBound<Real>;
        const Real mx = largest_size(B::min_size, a1.x, a2.x, b0.x, b1.x, b2.x);
        const Real my = largest_size(B::min_size, a1.y, a2.y, b0.y, b1.y, b2.y);
        const Real mz = largest_size(B::min_size, a1.z, a2.z, b0.z, b1.z, b2.z);
        constexpr Real factor = B::bound * B::headroom, back = 1 / B::headroom;
        bound = ((mx * my) * (mz * factor)) * back;
    } else {
        const Real all = above_a0 + above_b1;
        bound = size_of(all - all);
    }
    const auto certain = [bound](Real v) { return size_of(v) > bound; };

    const LoneCorner la(above_b0, above_b1, above_b2), lb(above_a0, above_a1, above_a2);
    const bool certain_a = certain(above_b0) && certain(above_b1) && certain(above_b2);
    const bool certain_b = certain(above_a0) && certain(above_a1) && certain(above_a2);
    if ((certain_a && !la.exists()) || (certain_b && !lb.exists()))
        return Answer::no;
    if (!certain_a || !certain_b)
        return Answer::maybe;

    const bool swapped = la.below != lb.below;
    const Real next01 = lb.next(s01_01, s01_02, s01_12), last01 = lb.last(s01_01, s01_02, s01_12);
    const Real next02 = lb.next(s02_01, s02_02, s02_12), last02 = lb.last(s02_01, s02_02, s02_12);
    const Real next12 = lb.next(s12_01, s12_02, s12_12), last12 = lb.last(s12_01, s12_02, s12_12);
    const Real first = swapped ? la.last(next01, next02, next12) : la.next(next01, next02, next12);
    const Real second = swapped ? la.next(last01, last02, last12) : la.last(last01, last02, last12);
    const bool first_turned = swapped ? la.last_turned() : la.next_turned();
    const bool second_turned = swapped ? la.next_turned() : la.last_turned();
    const bool right1 = ((first < 0) != la.below) != (first_turned != lb.next_turned());
    const bool wrong2 = ((second < 0) != la.below) != (second_turned != lb.last_turned());
    if (!certain(first) || !certain(second))
        return Answer::maybe;
    return right1 && !wrong2 ? Answer::yes : Answer::no;
}

} // namespace boxwood::detail
