#pragma once

#include "kernels/convex/detail/relative_pose.h"
#include "kernels/convex/detail/simplex.h"

/// Gilbert, Johnson, Keerthi 1988, "A fast procedure for computing the distance between complex
/// objects in three-dimensional space", on the cores of two shapes in the first one's frame.
/// Each turn: the nearest point v of a simplex in D = A - B (an upper bound, |v|); the farthest
/// point w of D towards the origin (a lower bound, v.w / |v|: all of D is beyond that plane); w is
/// added. Ends when the bounds meet, when they are good enough, or when rounding leaves no
/// progress: |v| falls in every turn but a few, and the turns are counted. The bounds hold whatever
/// happened.
namespace boxwood::convex::detail {

/// The points of one core minus those of another.
template <class A, class B> struct Difference {
    const A& a;
    const B& b;
    const RelativePose& b_in_a;

    /// The farthest point along d.
    Simplex::Vertex along(Vec3<double> d) const {
        const Vec3<double> x = support(a, d);
        return {x - b_in_a(support(b, b_in_a.rotated_back(-d))), x};
    }
};

/// A difference whose type is not known: for what is called seldom.
struct AnyDifference {
    const void* difference;
    Simplex::Vertex (*along_in)(const void*, Vec3<double>);

    template <class A, class B>
    explicit AnyDifference(const Difference<A, B>& d)
        : difference(&d), along_in([](const void* self, Vec3<double> way) {
              return static_cast<const Difference<A, B>*>(self)->along(way);
          }) {}
    Simplex::Vertex along(Vec3<double> d) const { return along_in(difference, d); }
};

/// When a search may end.
struct Goal {
    double size;             ///< of all: reaches and translation
    double relative, slack;  ///< when hi - lo <= relative |hi - radius| + slack
    double radius = 0;       ///< of both, around their cores
    double lo_enough = inf;  ///< when lo is more
    double hi_enough = -inf; ///< when hi is less

    bool reached(double lo, double hi) const {
        return (hi < inf && hi - lo <= relative * std::abs(hi - radius) + slack) ||
               lo > lo_enough || hi < hi_enough;
    }
};

/// The signed distance of two cores as computed; distance_error is yet to be added.
struct CoreDistance {
    double lo = -inf, hi = inf;
    Vec3<double> normal{0, 0, 1}; ///< from a to b, unit; where lo was found
    Vec3<double> between{};       ///< from b's point to a's
    Vec3<double> on_a{};
    bool overlapping = false; ///< GJK: or too near to tell; lo says little
};

/// d of unit length, or `other` if it has none.
[[gnu::always_inline]] inline Vec3<double> unit_or(Vec3<double> d, Vec3<double> other) {
    const double size = length(d);
    return size > 0x1p-500 && size < 0x1p500 ? d * (1 / size) : other;
}

/// Neither 0 nor so short or long that products with lengths in range leave the range of doubles.
inline bool usable(Vec3<double> d) {
    const double squared = dot(d, d);
    return squared > 0x1p-800 && squared < 0x1p800;
}

/// Below this the nearest point of a simplex is not told from the origin.
inline double touching_size(double size) { return 16 * u * size; }

/// start: from a towards b. `ended` is the simplex where the search ended.
template <class D>
CoreDistance nearest_to_origin(const D& difference, Vec3<double> start, const Goal& goal,
                               Simplex& ended) {
    constexpr int max_turns = 128, max_level_turns = 24;
    const double rounding = touching_size(goal.size) / 4;
    int level_turns = 0; // a far vertex may turn v, yet gain less than rounding
    CoreDistance found;
    Simplex buffer[2];
    Simplex* simplex = buffer;
    Simplex* spare = buffer + 1;
    Vec3<double> v = -start; // the direction of the nearest point, of any length
    for (int turn = 0; turn < max_turns; ++turn) {
        const Simplex::Vertex next = difference.along(-v);
        if (const double gap = dot(v, next.w) / length(v); gap > found.lo) {
            found.lo = gap;
            found.normal = v;
            if (goal.reached(gap, found.hi))
                break;
        }
        const bool known = simplex->holds(next.w);
        double hi = inf;
        if (!known) {
            simplex->add(next);
            reduce(*simplex, *spare);
            hi = length(spare->nearest);
        }
        const auto gains = [&] {
            return hi < found.hi || spare->encloses ||
                   (!known && hi <= found.hi + rounding && spare->holds(next.w) &&
                    ++level_turns <= max_level_turns);
        };
        if (!gains()) {
            reduce_thoroughly(*simplex, *spare);
            hi = length(spare->nearest);
            if (!gains()) {
                simplex->size -= known ? 0 : 1; // as it was
                break;
            }
        }
        std::swap(simplex, spare);
        found.hi = hi;
        if (simplex->encloses || hi <= touching_size(goal.size)) {
            found.overlapping = true;
            const double depth = -1.25 * goal.hi_enough;
            if (simplex->encloses && depth > 0 && encloses_ball(*simplex, depth))
                found.hi = -depth;
            break;
        }
        if (goal.reached(found.lo, hi))
            break;
        v = usable(simplex->direction) ? simplex->direction : simplex->nearest;
    }
    ended = *simplex;
    found.normal = unit_or(-found.normal, {0, 0, 1});
    found.on_a = simplex->on_a();
    found.between = simplex->nearest;
    return found;
}

} // namespace boxwood::convex::detail
