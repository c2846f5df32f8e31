#pragma once

#include "kernels/triangle_triangle/detail/crossing.h"
#include "kernels/triangle_triangle/detail/float_grid.h"
#include "kernels/triangle_triangle/detail/interval_test.h"
#include "kernels/triangle_triangle/detail/plain_signs.h"

/// Whether two closed triangles of floats share a point, as a thread of a device decides it: by
/// accuracy level, in memory of fixed size. NaN and infinity: maybe, at each level.
namespace boxwood::float_pair {

BOXWOOD_BOTH inline Triangle<double> widened(const Triangle<float>& t) {
    using Point = Vec3<double>;
    return {static_cast<Point>(t.a), static_cast<Point>(t.b), static_cast<Point>(t.c)};
}

/// Promises nothing; the answers of GuigueDevillersF64, bit for bit.
BOXWOOD_BOTH inline Answer plain_in_doubles(const Triangle<float>& a, const Triangle<float>& b) {
    detail::PlainSigns<double> signs(widened(a), widened(b));
    return detail::IntervalTest<decltype(signs)>::meet(signs);
}

/// What plain() leaves to it.
BOXWOOD_BOTH [[gnu::noinline]] inline Answer plain_near_zero(Triangle<float> a, Triangle<float> b) {
    detail::PlainSigns<float> signs(a, b);
    return detail::IntervalTest<decltype(signs)>::meet(signs);
}
/// Promises nothing; the answers of GuigueDevillersF32Batch, bit for bit.
BOXWOOD_BOTH inline Answer plain(const Triangle<float>& a, const Triangle<float>& b) {
    const Answer answer = detail::crossing<float, false>(a, b);
    return answer != Answer::maybe ? answer : plain_near_zero(a, b);
}

BOXWOOD_BOTH inline bool is_finite(const Triangle<float>& t) {
    bool all = true;
    for (int k = 0; k < 3; ++k)
        all = all && detail::Binary32::is_finite(t.a[k]) && detail::Binary32::is_finite(t.b[k]) &&
              detail::Binary32::is_finite(t.c[k]);
    return all;
}
BOXWOOD_BOTH inline bool share_a_vertex(const Triangle<float>& a, const Triangle<float>& b) {
    const auto is_of_b = [&](const Vec3<float>& p) {
        const auto same = [&](const Vec3<float>& q) {
            return p.x == q.x && p.y == q.y && p.z == q.z;
        };
        return same(b.a) || same(b.b) || same(b.c);
    };
    return is_of_b(a.a) || is_of_b(a.b) || is_of_b(a.c);
}

/// Yes and no are proven, by the bound of guigue_devillers_batch.cpp in floats, then in doubles, or
/// by a shared vertex; else maybe.
BOXWOOD_BOTH inline Answer certified(const Triangle<float>& a, const Triangle<float>& b) {
    if (const Answer answer = detail::crossing<float, true>(a, b); answer != Answer::maybe)
        return answer;
    if (share_a_vertex(a, b))
        return is_finite(a) && is_finite(b) ? Answer::yes : Answer::maybe;
    return detail::crossing<double, true>(widened(a), widened(b));
}

/// Exact for all finite floats if Grid is WideFloats; for NarrowFloats where fits is left true.
template <class Grid>
BOXWOOD_BOTH Answer exact_on(const Triangle<float>& a, const Triangle<float>& b, bool& fits) {
    if (!is_finite(a) || !is_finite(b))
        return Answer::maybe;
    const detail::FloatSigns<Grid> signs(a, b);
    fits = signs.fits();
    return fits ? detail::IntervalTest<const detail::FloatSigns<Grid>>::meet(signs) : Answer::maybe;
}
using detail::NarrowFloats;
using detail::WideFloats;

} // namespace boxwood::float_pair
