// Compiled with -frounding-math, which CGAL's target sets.
#include "bench/peers/each_case.h"
#include "bench/peers/kernel_peers.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cmath>
#include <type_traits>

namespace boxwood::bench {
namespace {

using Inexact = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;

/// CGAL requires triangles that are not degenerate, and segments likewise: `valid` is found before
/// timing, and other cases are answered `maybe` or NaN.
template <class K> struct TrianglePair {
    typename K::Triangle_3 a, b;
    bool valid;
    explicit TrianglePair(const TrianglePairCase& c)
        : a(triangle(c.a)), b(triangle(c.b)), valid(!a.is_degenerate() && !b.is_degenerate()) {}
    static typename K::Point_3 point(Vec3<double> v) { return {v.x, v.y, v.z}; }
    static typename K::Triangle_3 triangle(const Triangle<double>& t) {
        return {point(t.a), point(t.b), point(t.c)};
    }
};

template <class K> Decision intersect(const TrianglePair<K>& p) {
    if (!p.valid)
        return {Answer::maybe, 0};
    return yes_or_no(CGAL::do_intersect(p.a, p.b));
}

/// The root of an exact square, also where the square itself is beyond the doubles.
double root(const Exact::FT& squared) {
    constexpr double usual_min = 0x1p-900, usual_max = 0x1p900;
    squared.exact(); // else a double within 1e-5 would do for CGAL
    const double nearest = CGAL::to_double(squared);
    if ((nearest > usual_min && nearest < usual_max) || CGAL::is_zero(squared))
        return std::sqrt(nearest);
    const bool small = nearest <= usual_min;
    Exact::FT scaled = squared;
    int exponent = 0;
    for (double x = nearest; !(x > usual_min && x < usual_max); x = CGAL::to_double(scaled)) {
        scaled *= small ? Exact::FT(0x1p600) : Exact::FT(0x1p-600);
        exponent += small ? -300 : 300;
    }
    return std::ldexp(std::sqrt(CGAL::to_double(scaled)), exponent);
}
double root(double squared) { return std::sqrt(squared); }

template <class K> Distance distance(const TrianglePair<K>& p) {
    if (!p.valid)
        return plain_distance(std::nan(""));
    return plain_distance(root(CGAL::squared_distance(p.a, p.b)));
}

} // namespace

std::vector<ContenderEntry> cgal_kernels() {
    const std::string notes = "degenerate triangles, which CGAL does not take, are answered maybe; "
                              "one pair per call";
    using Pair = TrianglePairCase;
    return {
        each_case<Pair, TrianglePair<Inexact>, intersect<Inexact>>(
            "triangle_triangle", "cgal", "epick.do_intersect", "f64",
            "CGAL's do_intersect, exact predicates and inexact constructions", notes),
        each_case<Pair, TrianglePair<Exact>, intersect<Exact>>(
            "triangle_triangle", "cgal", "epeck.do_intersect", "f64",
            "CGAL's do_intersect, exact predicates and exact constructions", notes),
        each_case<Pair, TrianglePair<Inexact>, distance<Inexact>>(
            "triangle_distance", "cgal", "epick.squared_distance", "f64",
            "CGAL's squared_distance in doubles", notes + "; the root is taken of its answer"),
        each_case<Pair, TrianglePair<Exact>, distance<Exact>>(
            "triangle_distance", "cgal", "epeck.squared_distance", "f64",
            "CGAL's squared_distance, exact", notes + "; the root is taken of its answer"),
    };
}

} // namespace boxwood::bench
