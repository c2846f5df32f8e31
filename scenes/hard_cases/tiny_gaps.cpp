/// Distances far below the rounding of what they are distances of.

#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

#include <array>
#include <cmath>
#include <utility>

namespace boxwood {
namespace {

using Vec = Vec3<double>;

/// a in or below the plane z = 0, b at or above z = gap: a face and a corner, two edges that cross,
/// or two faces. The axes are exchanged, which is exact.
TrianglePairCase draw_tiny_gap(Draws& draws, int k) {
    const double gap = draw_small(draws, draw_coin(draws) ? k : (k + 1) / 2);
    const auto high = [&] { return draws.uniform(0.25, 1); };
    const auto beside = [&](Vec p, double z) {
        const Vec aside = draws.in_ball();
        return Vec{p.x + aside.x, p.y + aside.y, z};
    };
    Triangle<double> a = draw_triangle(draws), b;
    a.a.z = a.b.z = a.c.z = 0;
    const Vec p = draw_inside(a, draws);
    switch (draw_integer(draws, 0, 2)) {
    case 0:
        b = {{p.x, p.y, gap}, beside(p, high()), beside(p, high())};
        break;
    case 1:
        b = {beside(p, gap), beside(p, gap), beside(p, gap)};
        break;
    default: {
        const Vec d = draws.unit_vector(), e = draws.unit_vector();
        a = {{p.x + d.x, p.y + d.y, 0}, {p.x - d.x, p.y - d.y, 0}, beside(p, -high())};
        b = {{p.x + e.x, p.y + e.y, gap}, {p.x - e.x, p.y - e.y, gap}, beside(p, high())};
    }
    }
    std::array corners{&a.a, &a.b, &a.c, &b.a, &b.b, &b.c};
    for (auto turns = draw_integer(draws, 0, 2); turns > 0; --turns)
        for (Vec* q : corners)
            *q = {q->z, q->x, q->y};
    if (draw_coin(draws))
        std::swap(a, b);
    return {a, b, Known::no};
}

/// Two triangles of nearly one plane, one of them 10^-13 to 10^-k wide, that miss by about that
/// or by a part of it.
TrianglePairCase draw_coplanar_needles(Draws& draws, int k) {
    const auto needle = [&] {
        const double width = draw_small(draws, static_cast<int>(draw_integer(draws, 13, k)));
        const double left = -draws.uniform(0.5, 1), right = draws.uniform(0.5, 1);
        return Triangle<double>{
            {left, 0, 0}, {right, 0, 0}, {draws.uniform(left, right), width, 0}};
    };
    const auto plump = [&] {
        Triangle<double> t = draw_triangle(draws);
        t.a.z = t.b.z = t.c.z = 0;
        return t;
    };
    const RigidTransform<double> turn = draw_rotation(draws);
    TrianglePairCase pair;
    pair.a = needle();
    pair.b = draw_coin(draws) ? needle() : plump();
    const Vec on_a = draw_inside(pair.a, draws), side = draws.unit_vector();
    const double c = side.x, s = side.y, size = std::sqrt(c * c + s * s);
    const RigidTransform<double> in_plane{
        {Vec{c / size, -s / size, 0}, {s / size, c / size, 0}, {0, 0, 1}}, {}};
    pair.b = in_plane * pair.b;
    const Vec on_b = draw_coin(draws) ? pair.b.a : draw_inside(pair.b, draws);
    const double miss = draw_small(draws, static_cast<int>(draw_integer(draws, 11, 18)));
    pair.b = pair.b + (on_a - on_b);
    pair.a = turn * pair.a;
    pair.b = turn * pair.b + turn(Vec{0, 0, miss});
    if (draw_coin(draws))
        std::swap(pair.a, pair.b);
    return pair;
}

} // namespace

HardCaseFamily tiny_gaps_family() {
    HardCaseFamily family =
        with_k(rounded_family("tiny_gaps", "sizes of 1, and gaps of 10^-k or 10^-(k/2)",
                              Panel::degenerate, rounded_pairs<draw_tiny_gap>),
               "the gap is 10^-k or 10^-(k/2)", 200, 2, 200);
    family.scale_min = -350; // bits down to 2^-719
    return family;
}

HardCaseFamily near_coplanar_needles_family() {
    return with_k(rounded_family("near_coplanar_needles",
                                 "triangles of nearly one plane, one 10^-13 to 10^-k wide, that "
                                 "miss by 1e-11 to 1e-18",
                                 Panel::degenerate, rounded_pairs<draw_coplanar_needles>),
                  "the needle is at least 10^-k wide", 16, 13, 16);
}

} // namespace boxwood
