#pragma once

#include "kernels/detail/rescale.h"
#include "kernels/primitives/triangle.h"
#include "kernels/triangle_distance/detail/one_lane.h"

#include <array>
#include <cmath>

namespace boxwood::detail {

/// Finds the nearest points of two triangles in plain arithmetic, mostly from few of their 15
/// features: two edges that face each other are tried first. by_cross: solves for the edges'
/// parameters by their cross product. Functions return false if the triangles are so large or small
/// that products would leave the range of Real, or have NaN.
template <class Real, bool by_cross> class NearestPairSearch {
  public:
    using Pair = one_lane::PointPair<Real>;

    /// Two guesses, and all features if both were wrong.
    HWY_INLINE static bool find(const Triangle<Real>& a, const Triangle<Real>& b, Pair& found) {
        Guess guess(a, b);
        return guess.next(found) || look_closer(a, b, &guess, found);
    }
    /// One guess, and all features if it was wrong: what a batch does.
    HWY_INLINE static bool find_by_one_guess(const Triangle<Real>& a, const Triangle<Real>& b,
                                             Pair& found) {
        Guess guess(a, b);
        return guess.next(found) || look_closer(a, b, nullptr, found);
    }

  private:
    /// The pairs of edges that face each other along some way: at first from centre to centre, then
    /// between the points that were found.
    struct Guess {
        const Vec3<Real>*a[5], *b[5]; ///< the corners, twice round
        Vec3<Real> a1, a2, b1, b2, way;
        int last = -1;

        Guess(const Triangle<Real>& ta, const Triangle<Real>& tb)
            : a{&ta.a, &ta.b, &ta.c, &ta.a, &ta.b}, b{&tb.a, &tb.b, &tb.c, &tb.a, &tb.b},
              a1(ta.b - ta.a), a2(ta.c - ta.a), b1(tb.b - tb.a), b2(tb.c - tb.a),
              way(one_lane::way_between(tb.a - ta.a, a1, a2, b1, b2)) {}

        bool next(Pair& found) {
            const int i = lower_of(dot(way, a1), dot(way, a2));
            const int j = lower_of(-dot(way, b1), -dot(way, b2));
            const int before = last;
            last = 3 * i + j;
            if (last == before)
                return false;
            const bool nearest = one_lane::facing_edges<by_cross>(
                *a[i], *a[i + 1], *a[i + 2], *b[j], *b[j + 1], *b[j + 2], found);
            way = -found.offset;
            return nearest;
        }

        /// Which of 0, x, y is least; without a branch, which would be a toss-up.
        static int lower_of(Real x, Real y) {
            const int third = y < one_lane::min(x, Real(0)), second = x < 0;
            return 2 * third + (second & ~third);
        }
    };

    /// If they cross, a common point; else another guess, if given, then all features.
    [[gnu::noinline]] static bool look_closer(const Triangle<Real>& a, const Triangle<Real>& b,
                                              Guess* guess, Pair& found) {
        const one_lane::Shape<Real> shape_a(a.a, a.b, a.c);
        const one_lane::Shape<Real> shape_b(b.a, b.b, b.c);
        const one_lane::Facing<Real> facing(shape_a, shape_b);
        if (!facing.in_range())
            return false;
        one_lane::Best<Real> best;
        if (!offer_crossing(facing, best)) {
            if (guess && guess->next(found))
                return true;
            one_lane::offer_features<by_cross>(facing, false, best);
        }
        found = best_pair(facing, best);
        return true;
    }
};

template <class Real> Distance distance_of(const one_lane::PointPair<Real>& found) {
    const auto d = static_cast<double>(std::sqrt(found.squared));
    const Vec3<Real>&a = found.a, &b = found.b;
    return {d, d, d, {a.x, a.y, a.z}, {b.x, b.y, b.z}, 0};
}

template <auto find, class Real>
[[gnu::noinline]] Distance measured_at_unit_size(const Triangle<Real>& a, const Triangle<Real>& b) {
    const std::array points{a.a, a.b, a.c, b.a, b.b, b.c};
    return at_unit_size(points, a, b, [](const auto& ua, const auto& ub) {
        one_lane::PointPair<Real> found{0, {}, ua.a, ub.a}; // where all is one point
        find(ua, ub, found);
        return distance_of(found);
    });
}

/// The distance of the points that `find` finds, a function of NearestPairSearch; at any size.
template <auto find, class Real>
Distance measured(const Triangle<Real>& a, const Triangle<Real>& b) {
    one_lane::PointPair<Real> found;
    if (find(a, b, found)) [[likely]]
        return distance_of(found);
    return measured_at_unit_size<find>(a, b);
}

} // namespace boxwood::detail
