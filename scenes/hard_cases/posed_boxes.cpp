#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

#include <algorithm>
#include <cmath>

namespace boxwood {
namespace {

using Vec = Vec3<double>;

using DrawObbPair = ObbPairCase (*)(Draws& draws, int k);
template <DrawObbPair draw> Cases obb_pairs(const HardCaseSpec& spec, const Random& random) {
    std::vector<ObbPairCase> cases(spec.n);
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        cases[i] = draw(draws, *spec.k);
        for (Obb<double>* box : {&cases[i].a, &cases[i].b}) {
            box->centre = scaled(box->centre, spec.scale);
            box->half = scaled(box->half, spec.scale);
        }
    }
    return cases;
}

/// The columns of a rotation.
std::array<Vec, 3> axes_of(const RigidTransform<double>& turn) {
    const auto column = [&](int k) {
        return Vec{turn.rotation[0][k], turn.rotation[1][k], turn.rotation[2][k]};
    };
    return {column(0), column(1), column(2)};
}

Obb<double> draw_obb(Draws& draws) {
    Obb<double> box;
    box.axis = axes_of(draw_rotation(draws));
    box.half = {draws.uniform(0.125, 1), draws.uniform(0.125, 1), draws.uniform(0.125, 1)};
    return box;
}

/// Centres up to 1.75 apart: about half of them touch.
ObbPairCase generic_boxes(Draws& draws, int) {
    ObbPairCase pair{draw_obb(draws), draw_obb(draws)};
    pair.a.centre = draw_offset(draws);
    pair.b.centre = pair.a.centre + 1.75 * draws.in_ball();
    return pair;
}

/// Entry 3 of the hard cases with other rotations: two cubes of one pose, the second moved by their
/// side and a gap along an axis.
ObbPairCase kissing(Draws& draws, int) {
    constexpr double sides[] = {0.01, 0.25, 0.5, 10, 1000};
    constexpr double gaps[] = {0, 1e-16, -1e-16, 2.5e-16, -2.5e-16, 1e-15, -1e-15};
    const double side = sides[draw_integer(draws, 0, 4)];
    const double gap = gaps[draw_integer(draws, 0, 6)] * std::max(1.0, side);
    Obb<double> a;
    a.axis = axes_of(draw_rotation(draws));
    a.half = {side / 2, side / 2, side / 2};
    a.centre = 2.0 * draw_offset(draws);
    Obb<double> b = a;
    b.centre =
        a.centre + (side + gap) * a.axis[static_cast<std::size_t>(draw_integer(draws, 0, 2))];
    return {a, b};
}

/// The corner of a box that is farthest along n, its place along axis `along` (-1: none) by choice.
Vec farthest(const Obb<double>& box, Vec n, int along, double place) {
    Vec p = box.centre;
    for (int k = 0; k < 3; ++k) {
        const Vec axis = box.axis[static_cast<std::size_t>(k)];
        p = p + (k == along ? place : std::copysign(box.half[k], dot(n, axis))) * axis;
    }
    return p;
}

/// Boxes of different poses that touch, up to rounding: edge on edge, or corner on face. Then the
/// second is moved off or inwards, by up to 2^k ulp of 1. The axes are orthonormal up to rounding
/// or, every other time, up to as much as they are moved by.
ObbPairCase touching(Draws& draws, int k) {
    Obb<double> a = draw_obb(draws), b = draw_obb(draws);
    const auto moved_by = static_cast<int>(draw_integer(draws, 0, k)) - 52;
    if (draw_coin(draws))
        for (Obb<double>* box : {&a, &b})
            for (Vec& axis : box->axis)
                axis = axis + std::ldexp(1.0, moved_by) * draw_offset(draws);
    a.centre = draw_offset(draws);
    Vec n, on_a, on_b;
    if (draw_coin(draws)) {
        const auto i = draw_integer(draws, 0, 2), j = draw_integer(draws, 0, 2);
        n = cross(a.axis[static_cast<std::size_t>(i)], b.axis[static_cast<std::size_t>(j)]);
        const auto on_edge = [&](const Obb<double>& box, Vec away, std::int64_t edge) {
            const auto along = static_cast<int>(edge);
            return farthest(box, away, along, box.half[along] * draws.uniform(-1, 1));
        };
        on_a = on_edge(a, n, i);
        on_b = on_edge(b, -n, j);
    } else {
        const auto face = static_cast<int>(draw_integer(draws, 0, 2));
        n = cross(a.axis[static_cast<std::size_t>((face + 1) % 3)],
                  a.axis[static_cast<std::size_t>((face + 2) % 3)]) *
            (draw_coin(draws) ? 1.0 : -1.0);
        on_a = farthest(a, n, -1, 0);
        for (int i = 0; i < 3; ++i)
            if (i != face)
                on_a = on_a - draws.uniform(0, 2 * a.half[i]) *
                                  std::copysign(1.0, dot(n, a.axis[static_cast<std::size_t>(i)])) *
                                  a.axis[static_cast<std::size_t>(i)];
        on_b = farthest(b, -n, -1, 0);
    }
    const double size = length(n);
    if (size > 0)
        n = n * (1 / size);
    b.centre = on_a - on_b + std::ldexp(draws.uniform(-1, 1), moved_by) * n;
    return draw_coin(draws) ? ObbPairCase{a, b} : ObbPairCase{b, a};
}

/// Plates of half size 1, 1, 10^-k face to face, the gap +-10^-j of their thickness; every other
/// time one is turned by (3, 4, 5) within its plane.
ObbPairCase thin(Draws& draws, int k) {
    Obb<double> a;
    a.axis = axes_of(draw_rotation(draws));
    a.half = {1, 1, power_of_ten(-k)};
    a.centre = draw_offset(draws);
    Obb<double> b = a;
    const double thickness = 2 * a.half.z;
    const double gap = thickness * draw_small(draws, static_cast<int>(draw_integer(draws, 0, 15)));
    const double along = draw_coin(draws) ? thickness + gap : thickness - gap;
    const double aside[2] = {draws.uniform(-1.5, 1.5), draws.uniform(-1.5, 1.5)};
    b.centre = a.centre + along * a.axis[2] + aside[0] * a.axis[0] + aside[1] * a.axis[1];
    if (draw_coin(draws)) {
        b.axis[0] = 0.6 * a.axis[0] + 0.8 * a.axis[1];
        b.axis[1] = 0.6 * a.axis[1] - 0.8 * a.axis[0];
    }
    return {a, b};
}

/// Boxes of sides up to 1, every fourth flat, 2^k from the origin; the rotation any or tiny.
Cases rotated(const HardCaseSpec& spec, const Random& random) {
    std::vector<FitCase> cases(spec.n);
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        FitCase& fit = cases[i];
        if (draw_coin(draws)) {
            fit.transform = draw_rotation(draws);
        } else {
            double q[3];
            for (double& component : q)
                component = static_cast<double>(draw_integer(draws, -64, 64));
            fit.transform = rotation_of(0x1p25, q[0], q[1], q[2]);
        }
        const Vec centre = std::ldexp(1.0, *spec.k) * draw_offset(draws);
        Vec half = 0.5 * draws.in_cube();
        if (draw_integer(draws, 0, 3) == 0)
            half[static_cast<int>(draw_integer(draws, 0, 2))] = 0;
        fit.transform.translation =
            scaled(std::ldexp(1.0, *spec.k) * draw_offset(draws), spec.scale);
        fit.box = {scaled(centre - half, spec.scale), scaled(centre + half, spec.scale)};
    }
    return cases;
}

} // namespace

HardCaseFamily generic_obbs_family() {
    return rounded_family("generic_obbs", "boxes in any pose, about half of the pairs touching",
                          Panel::generic, obb_pairs<generic_boxes>);
}

HardCaseFamily kissing_obbs_family() {
    return rounded_family("kissing_obbs",
                          "cubes of one pose face to face, the gap a rounding error",
                          Panel::touching, obb_pairs<kissing>);
}

HardCaseFamily touching_obbs_family() {
    return with_k(rounded_family("touching_obbs",
                                 "boxes of two poses, edge on edge or corner on face, up to ulps",
                                 Panel::touching, obb_pairs<touching>),
                  "the gap is up to 2^k ulp of 1, either way", 12, 0, 40);
}

HardCaseFamily thin_obbs_family() {
    return with_k(rounded_family("thin_obbs", "plates 10^-k thick, face to face, nearly touching",
                                 Panel::degenerate, obb_pairs<thin>),
                  "thickness 10^-k of the width", 3, 0, 9);
}

HardCaseFamily rotated_boxes_family() {
    return with_k(rounded_family("rotated_boxes",
                                 "boxes to be fitted after a rotation, any or tiny", Panel::generic,
                                 rotated),
                  "distance 2^k from the origin", 0, 0, 40);
}

} // namespace boxwood
