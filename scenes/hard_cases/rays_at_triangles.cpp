#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

namespace boxwood {
namespace {

using Vec = Vec3<double>;

/// One ray a triangle: `draw(draws, k, ray_case)` gives the triangle and fills in the ray.
/// Positions are multiplied by 2^scale, directions are left as they are.
template <class Draw> Cases single_rays(const HardCaseSpec& spec, const Random& random, Draw draw) {
    RayCases cases;
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        RayCase& ray = cases.rays.emplace_back();
        const Triangle<float> t = draw(draws, *spec.k, ray);
        cases.triangles.push_back(
            {scaled(t.a, spec.scale), scaled(t.b, spec.scale), scaled(t.c, spec.scale)});
        ray.first = static_cast<std::uint32_t>(i);
        ray.ray.origin = scaled(ray.ray.origin, spec.scale);
    }
    return cases;
}

Triangle<float> rounded(const Triangle<double>& t) {
    return {Vec3<float>(t.a), Vec3<float>(t.b), Vec3<float>(t.c)};
}

Triangle<float> generic_ray(Draws& draws, int, RayCase& ray) {
    const Triangle<double> t = draw_triangle(draws);
    const Vec inside = draw_inside(t, draws), aside = draws.in_ball();
    const Vec target = draw_coin(draws) ? inside : inside + aside;
    const Vec direction = draws.unit_vector();
    ray.ray.direction = Vec3<float>(direction);
    ray.ray.origin = Vec3<float>(target - draws.uniform(1, 4) * direction);
    return rounded(t);
}

/// Integers of at most 34 2^18, which floats hold: the ray runs in the triangle's plane z = 0,
/// through its inside or along an edge. By definition it misses.
Triangle<float> in_plane(Draws& draws, int, RayCase& ray) {
    constexpr std::int64_t size = 1 << 16;
    const LatticeTriangle t = draw_around_origin(draws, size);
    const LatticeMap tilt = draw_tilt(draws, 3);
    const LatticePoint shift = draw_point(draws, {-size, -size, -size}, {size, size, size});
    const LatticePoint towards = draw_coin(draws)
                                     ? draw_point(draws, {1, -size / 2, 0}, {size / 2, size / 2, 0})
                                     : t[1] - t[0];
    const LatticePoint through = draw_coin(draws) ? LatticePoint{} : t[0];
    const auto placed = [&](LatticePoint p) { return Vec3<float>(to_scene(tilt(p + shift), -16)); };
    ray.ray.origin = placed(through - towards);
    ray.ray.direction = Vec3<float>(to_scene(tilt(towards), -16));
    ray.hit = Known::no;
    return {placed(t[0]), placed(t[1]), placed(t[2])};
}

/// At a point inside or just outside, from 2^k away at a slope of 1 down to 2^-20.
Triangle<float> grazing(Draws& draws, int k, RayCase& ray) {
    const Triangle<double> t = draw_triangle(draws);
    const Vec inside = draw_inside(t, draws);
    const Vec target = draw_coin(draws) ? inside : inside + 0.25 * draws.in_ball();
    const Vec n = normal_of(t);
    const Vec up = n * (1 / length(n));
    const Vec along = cross(up, draws.unit_vector());
    const int exponent = -static_cast<int>(draw_integer(draws, 0, 20));
    const Vec direction = along + std::ldexp(draws.uniform(-1, 1), exponent) * up;
    ray.ray.direction = Vec3<float>(direction);
    ray.ray.origin = Vec3<float>(target - std::ldexp(draws.uniform(1, 2), k) * direction);
    return rounded(t);
}

/// Entry 5 of the hard cases: legs s, and a ray at (s/3, s/3) along the third axis; with the axes
/// permuted and mirrored, s from 10^-k to 10^(1 - k) and any target well inside.
Triangle<float> small(Draws& draws, int k, RayCase& ray) {
    const double s = power_of_ten(-k) * draws.uniform(1, 10);
    const Triangle<double> legs{{0, 0, 0}, {s, 0, 0}, {0, s, 0}};
    const Vec target = draw_inside(legs, draws);
    std::array<int, 3> axes{0, 1, 2};
    shuffle(axes, draws);
    const float sign = draw_coin(draws) ? 1.0f : -1.0f;
    const auto placed = [&](Vec p) {
        Vec3<float> q;
        for (int axis = 0; axis < 3; ++axis)
            q[axes[static_cast<std::size_t>(axis)]] = sign * static_cast<float>(p[axis]);
        return q;
    };
    ray.ray.origin = placed({target.x, target.y, -1});
    ray.ray.direction = placed({0, 0, 1});
    ray.hit = Known::yes;
    return {placed(legs.a), placed(legs.b), placed(legs.c)};
}

} // namespace

HardCaseFamily generic_rays_family() {
    return {.name = "generic_rays",
            .summary = "rays at triangles in the unit ball, more than half of them hitting",
            .panel = Panel::generic,
            .scale_min = -80,
            .scale_max = 120,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                return single_rays(spec, random, generic_ray);
            }};
}

HardCaseFamily ray_in_plane_family() {
    return {.name = "ray_in_plane",
            .summary = "rays in the triangle's plane, through it or along an edge: a miss",
            .panel = Panel::degenerate,
            .scale_min = -149 + 16,
            .scale_max = 120,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                return single_rays(spec, random, in_plane);
            }};
}

HardCaseFamily ray_grazing_family() {
    return {.name = "ray_grazing",
            .summary = "rays from 2^k away at a slope of 1 down to 2^-20",
            .panel = Panel::touching,
            .k_meaning = "distance 2^k",
            .k_default = 10,
            .k_min = 0,
            .k_max = 20,
            .scale_min = -80,
            .scale_max = 100,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                return single_rays(spec, random, grazing);
            }};
}

HardCaseFamily ray_at_small_triangle_family() {
    return {.name = "ray_at_small_triangle",
            .summary = "rays straight at triangles of legs 10^-k; they must hit",
            .panel = Panel::generic,
            .k_meaning = "legs of 10^-k to 10^(1 - k)",
            .k_default = 4,
            .k_min = 0,
            .k_max = 15,
            .scale_min = -60,
            .scale_max = 120,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                return single_rays(spec, random, small);
            }};
}

} // namespace boxwood
