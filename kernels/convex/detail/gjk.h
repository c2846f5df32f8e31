#pragma once

#include "kernels/convex/detail/relative_pose.h"
#include "kernels/convex/detail/simplex.h"

#include <bit>
#include <span>
#include <utility>

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
    Vertex along(Vec3<double> d) const {
        const Vec3<double> x = support(a, d);
        return {x - b_in_a(support(b, b_in_a.rotated_back(-d))), x};
    }
};

/// A difference whose type is not known: for what is called seldom.
struct AnyDifference {
    const void* difference;
    Vertex (*along_in)(const void*, Vec3<double>);

    template <class A, class B>
    explicit AnyDifference(const Difference<A, B>& d)
        : difference(&d), along_in([](const void* self, Vec3<double> way) {
              return static_cast<const Difference<A, B>*>(self)->along(way);
          }) {}
    Vertex along(Vec3<double> d) const { return along_in(difference, d); }
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

/// Whether a ball around the origin, which an edge or a face of the simplex goes through, is in the
/// difference: proven by the farthest points on all sides of it.
template <class D> bool surrounds_ball(const D& difference, const Simplex& s, double radius) {
    std::array<Vec3<double>, 4> ring;
    Vec3<double> up;
    if (s.size == 2) {
        const Vec3<double> a = s.vertex[0].w, b = s.vertex[1].w, across = square_to(b - a);
        ring = {a, difference.along(across).w, b, difference.along(-across).w};
        up = cross(ring[1] - ring[3], b - a);
    } else if (s.size == 3) {
        ring = {s.vertex[0].w, s.vertex[1].w, s.vertex[2].w};
        up = cross(ring[1] - ring[0], ring[2] - ring[0]);
    } else
        return false;
    return usable(up) && encloses_ball(std::span(ring).first(s.size == 2 ? 4 : 3),
                                       difference.along(up).w, difference.along(-up).w, radius);
}

/// start: from a towards b. `ended` is the simplex where the search ended.
template <class D>
CoreDistance nearest_to_origin(const D& difference, Vec3<double> start, const Goal& goal,
                               Simplex& ended) {
    constexpr int max_turns = 128, max_level_turns = 24;
    const double rounding = touching_size(goal.size) / 4;
    int level_turns = 0; // a far vertex may turn v, yet gain less than rounding
    CoreDistance found;
    Vertices vertices;
    Nearest buffer[2];
    Nearest *nearest = buffer, *tried = buffer + 1;
    Vec3<double> v = -start; // the direction of the nearest point, of any length
    for (int turn = 0; turn < max_turns; ++turn) {
        const auto slot = static_cast<std::size_t>(std::countr_one(nearest->used));
        const Vertex next = vertices[slot] = difference.along(-v);
        if (const double gap = dot(v, next.w) / length(v); gap > found.lo) {
            found.lo = gap;
            found.normal = v;
            if (goal.reached(gap, found.hi))
                break;
        }
        bool known = false;
        for (std::size_t i = 0; i < 4; ++i)
            known |= (nearest->used >> i & 1) != 0 && vertices[i].w == next.w;
        const unsigned used = nearest->used | (known ? 0 : 1u << slot);
        double hi = inf;
        const auto gains = [&] {
            return hi < found.hi || (hi < inf && tried->encloses) ||
                   (!known && hi <= found.hi + rounding && (tried->used >> slot & 1) != 0 &&
                    ++level_turns <= max_level_turns);
        };
        if (!known) {
            find_nearest(vertices, used, false, *tried);
            hi = length(tried->point);
        }
        if (!gains()) {
            find_nearest(vertices, used, true, *tried);
            hi = length(tried->point);
            if (!gains())
                break;
        }
        std::swap(nearest, tried);
        found.hi = hi;
        found.overlapping = nearest->encloses || hi <= touching_size(goal.size);
        if (found.overlapping || goal.reached(found.lo, hi))
            break;
        v = usable(nearest->direction) ? nearest->direction : nearest->point;
    }
    ended.size = 0;
    for (std::size_t i = 0; i < 4; ++i)
        if (nearest->used >> i & 1)
            ended.add(vertices[i]);
    if (const double depth = -1.25 * goal.hi_enough;
        found.overlapping && depth > 0 && depth < inf &&
        (nearest->encloses ? encloses_ball(vertices, depth)
                           : surrounds_ball(difference, ended, depth)))
        found.hi = -depth;
    found.normal = unit_or(-found.normal, {0, 0, 1});
    found.on_a = nearest->on_a(vertices);
    found.between = nearest->point;
    return found;
}

} // namespace boxwood::convex::detail
