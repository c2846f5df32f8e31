#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"
#include "scenes/hard_cases/rounded_triangles.h"

namespace boxwood {
namespace {

using Vec = Vec3<double>;

TrianglePairCase draw_any_pair(Draws& draws) {
    switch (draw_integer(draws, 0, 2)) {
    case 0:
        return draw_vertex_on_face(draws);
    case 1:
        return draw_edge_on_edge(draws);
    default:
        return draw_generic_pair(draws);
    }
}

/// Legs of 10^-k to 10^-k+1 and a gap of a fraction of them, by far more than the rounding.
/// Entry 1 of the hard cases is s = 1.7e-4, height s / 10, not turned.
TrianglePairCase tiny(Draws& draws, int k) {
    const double s = power_of_ten(-k) * draws.uniform(1, 10);
    const double h = s * draws.uniform(0.03125, 0.5);
    const Triangle<double> a{{0, 0, 0}, {s, 0, 0}, {0, s, 0}};
    const Triangle<double> b{
        {s / 4, s / 4, h}, {5 * s / 4, s / 4, h + s}, {s / 4, 5 * s / 4, h + s}};
    const RigidTransform<double> turn = draw_rotation(draws);
    return {turn * a, turn * b, Known::no};
}

/// b of size 10^k; a of size 10^-k at its face.
TrianglePairCase mixed(Draws& draws, int k) {
    const Triangle<double> b = draw_triangle(draws);
    const double large = power_of_ten(k), small = power_of_ten(-k);
    const Vec on_b = draw_inside(b, draws), aside = draws.in_ball();
    const Vec p = large * on_b + small * aside;
    const Triangle<double> a = draw_triangle(draws);
    return {{p + small * a.a, p + small * a.b, p + small * a.c},
            {large * b.a, large * b.b, large * b.c}};
}

TrianglePairCase decimal(Draws& draws, int k) {
    const double factor = power_of_ten(k);
    const auto larger = [&](const Triangle<double>& t) {
        return Triangle<double>{factor * t.a, factor * t.b, factor * t.c};
    };
    const TrianglePairCase pair = draw_any_pair(draws);
    return {larger(pair.a), larger(pair.b)};
}

TrianglePairCase far(Draws& draws, int k) {
    const TrianglePairCase pair = draw_any_pair(draws);
    const Vec away = power_of_ten(k) * draw_offset(draws);
    return {pair.a + away, pair.b + away};
}

} // namespace

HardCaseFamily tiny_triangles_family() {
    return {.name = "tiny_triangles",
            .summary = "small triangles a fraction of their size apart",
            .panel = Panel::generic,
            .k_meaning = "legs of 10^-k to 10^(1 - k)",
            .k_default = 4,
            .k_min = 0,
            .k_max = 16,
            .scale_min = -rounded_scale,
            .scale_max = rounded_scale,
            .generate = rounded_pairs<tiny>};
}

HardCaseFamily mixed_scale_family() {
    return {.name = "mixed_scale",
            .summary = "a triangle of size 10^-k at the face of one of size 10^k",
            .panel = Panel::touching,
            .k_meaning = "sizes 10^-k and 10^k",
            .k_default = 6,
            .k_min = 1,
            .k_max = 8,
            .scale_min = -rounded_scale,
            .scale_max = rounded_scale,
            .generate = rounded_pairs<mixed>};
}

HardCaseFamily decimal_scale_family() {
    return {.name = "decimal_scale",
            .summary = "generic and touching triangles of size 10^k, rounded there",
            .panel = Panel::touching,
            .k_meaning = "size 10^k",
            .k_default = 30,
            .k_min = -300,
            .k_max = 300,
            .generate = rounded_pairs<decimal>};
}

HardCaseFamily far_from_origin_family() {
    return {.name = "far_from_origin",
            .summary = "generic and touching triangles moved by 10^k, rounded there",
            .panel = Panel::touching,
            .k_meaning = "distance 10^k from the origin",
            .k_default = 6,
            .k_min = 1,
            .k_max = 12,
            .scale_min = -rounded_scale,
            .scale_max = rounded_scale,
            .generate = rounded_pairs<far>};
}

} // namespace boxwood
