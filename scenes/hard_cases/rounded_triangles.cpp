#include "scenes/hard_cases/rounded_triangles.h"

#include "scenes/hard_cases/lattice.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace boxwood {
namespace {

using Vec = Vec3<double>;

Vec normalized(Vec v) { return v * (1 / length(v)); }

Triangle<double> shuffled(const Triangle<double>& t, Draws& draws) {
    std::array<Vec, 3> corners{t.a, t.b, t.c};
    shuffle(corners, draws);
    return {corners[0], corners[1], corners[2]};
}

TrianglePairCase generic_pair(Draws& draws, int) { return draw_generic_pair(draws); }
TrianglePairCase vertex_on_face(Draws& draws, int) { return draw_vertex_on_face(draws); }
TrianglePairCase edge_on_edge(Draws& draws, int) { return draw_edge_on_edge(draws); }

/// Moved by up to `ulps` steps from one double to the next, on each axis.
Vec nudged(Vec p, int ulps, Draws& draws) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto steps = draw_integer(draws, -ulps, ulps);
        const double towards =
            std::copysign(std::numeric_limits<double>::infinity(), static_cast<double>(steps));
        for (auto left = std::abs(steps); left > 0; --left)
            p[axis] = std::nextafter(p[axis], towards);
    }
    return p;
}

TrianglePairCase within_ulps(Draws& draws, int ulps) {
    TrianglePairCase pair;
    if (draw_coin(draws)) {
        pair = draw_vertex_on_face(draws);
    } else {
        pair = draw_edge_on_edge(draws);
        pair.a.b = nudged(pair.a.b, ulps, draws);
    }
    pair.a.a = nudged(pair.a.a, ulps, draws);
    return pair;
}

/// In the planes z = 0 and z = 10^-k x, both turned and moved.
TrianglePairCase near_coplanar(Draws& draws, int k) {
    const double tilt = draw_small(draws, k);
    const Vec aside = 0.5 * draws.in_ball();
    const auto flat = [&] {
        const auto corner = [&] {
            const Vec p = draws.in_ball();
            return Vec{p.x, p.y, 0};
        };
        return Triangle<double>{corner(), corner(), corner()};
    };
    const Triangle<double> a = flat();
    Triangle<double> b = flat() + Vec{aside.x, aside.y, 0};
    for (Vec* p : {&b.a, &b.b, &b.c})
        p->z = tilt * p->x;
    const RigidTransform<double> turn = draw_rotation(draws);
    const Vec shift = draw_offset(draws);
    return {turn * a + shift, turn * b + shift};
}

/// The edges a.a a.b along x at z = 0 and b.a b.b at z = 10^-k, turned against it by an angle of
/// 1e-2 to 1e-16; the other corners lie below and above.
TrianglePairCase near_parallel(Draws& draws, int k) {
    const double gap = draw_small(draws, k);
    const double slope = draw_small(draws, static_cast<int>(draw_integer(draws, 1, 16)));
    const double ends[4] = {draws.uniform(-1, -0.25), draws.uniform(0.25, 1),
                            draws.uniform(-1, -0.25), draws.uniform(0.25, 1)};
    const double aside = draw_coin(draws) ? 0 : slope * draws.uniform(-1, 1);
    const Vec down{draws.uniform(-1, 1), draws.uniform(-1, 1), -draws.uniform(0.25, 1)};
    const Vec up{draws.uniform(-1, 1), draws.uniform(-1, 1), gap + draws.uniform(0.25, 1)};
    const Triangle<double> a{{ends[0], 0, 0}, {ends[1], 0, 0}, down};
    const Triangle<double> b{
        {ends[2], slope * ends[2] + aside, gap}, {ends[3], slope * ends[3] + aside, gap}, up};
    const RigidTransform<double> turn = draw_rotation(draws);
    const Vec shift = draw_offset(draws);
    return {turn * a + shift, turn * b + shift};
}

} // namespace

TrianglePairCase draw_generic_pair(Draws& draws) {
    TrianglePairCase pair;
    pair.a = draw_triangle(draws);
    if (draw_coin(draws)) {
        // An edge through a's inside.
        const Vec p = draw_inside(pair.a, draws), v = draws.unit_vector();
        const double before = draws.uniform(0.25, 1), after = draws.uniform(0.25, 1);
        pair.b = {p - before * v, p + after * v, p + draws.in_ball()};
    } else {
        const Vec aside = 1.25 * draws.unit_vector();
        pair.b = draw_triangle(draws) + aside;
    }
    pair.a = shuffled(pair.a, draws);
    pair.b = shuffled(pair.b, draws);
    if (draw_coin(draws))
        std::swap(pair.a, pair.b);
    return pair;
}

TrianglePairCase draw_vertex_on_face(Draws& draws) {
    TrianglePairCase pair;
    pair.b = draw_triangle(draws);
    const bool on_edge = draw_integer(draws, 0, 3) == 0;
    const Vec p = on_edge ? point_of(pair.b, draws.uniform(), 0) : draw_inside(pair.b, draws);
    const Vec n = normalized(normal_of(pair.b)) * (draw_coin(draws) ? 1.0 : -1.0);
    const auto above = [&] {
        const double height = draws.uniform(0.25, 1);
        return p + height * n + cross(n, draws.in_ball());
    };
    pair.a.a = p;
    pair.a.b = above();
    pair.a.c = above();
    return pair;
}

TrianglePairCase draw_edge_on_edge(Draws& draws) {
    const Vec p = draws.in_ball(), d = draws.unit_vector(), e = draws.unit_vector();
    const Vec n = normalized(cross(d, e));
    const auto reach = [&] { return draws.uniform(0.125, 1); };
    const auto edge = [&](Vec along, Vec away) {
        const double before = reach(), after = reach(), height = reach();
        const double aside = draws.uniform(-1, 1);
        return Triangle<double>{p - before * along, p + after * along,
                                p + height * away + aside * along};
    };
    TrianglePairCase pair;
    pair.a = edge(d, n);
    pair.b = edge(e, -n);
    return pair;
}

HardCaseFamily generic_triangles_family() {
    return rounded_family("generic_triangles",
                          "triangles in the unit ball, half of the pairs hitting", Panel::generic,
                          rounded_pairs<generic_pair>);
}

HardCaseFamily vertex_on_face_family() {
    return rounded_family("vertex_on_face", "a corner on the other's face or edge, up to rounding",
                          Panel::touching, rounded_pairs<vertex_on_face>);
}

HardCaseFamily edge_on_edge_family() {
    return rounded_family("edge_on_edge", "an edge across the other's edge, up to rounding",
                          Panel::touching, rounded_pairs<edge_on_edge>);
}

HardCaseFamily within_one_ulp_family() {
    return with_k(
        rounded_family("within_one_ulp",
                       "a corner on a face or an edge on an edge, each coordinate up to k ulps off",
                       Panel::touching, rounded_pairs<within_ulps>),
        "ulps that a touching coordinate is moved at most", 1, 1, 64);
}

HardCaseFamily near_coplanar_family() {
    return with_k(rounded_family("near_coplanar", "triangles of two planes at an angle of 10^-k",
                                 Panel::degenerate, rounded_pairs<near_coplanar>),
                  "the angle is 10^-k", 16, 1, 18);
}

HardCaseFamily near_parallel_edges_family() {
    return with_k(rounded_family("near_parallel_edges",
                                 "edges a gap of 10^-k apart at an angle of 1e-1 to 1e-16",
                                 Panel::degenerate, rounded_pairs<near_parallel>),
                  "the gap is 10^-k", 8, 1, 16);
}

} // namespace boxwood
