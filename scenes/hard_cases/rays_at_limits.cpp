#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

#include <cmath>
#include <limits>

namespace boxwood {
namespace {

enum class Side : std::uint8_t { below, on, above };

float beside(float t, Side side) {
    const float goal = side == Side::below ? 0 : std::numeric_limits<float>::infinity();
    return side == Side::on ? t : std::nextafter(t, goal);
}

/// One of the limits beside t, by a float or, every fourth time, by a half. Returns whether
/// `t` is within it.
bool draw_limit(Draws& draws, float t, Ray<float>& ray) {
    const auto side = static_cast<Side>(draw_integer(draws, 0, 2));
    float limit = beside(t, side);
    if (side != Side::on && draw_integer(draws, 0, 3) == 0)
        limit = side == Side::below ? t / 2 : t * 1.5f;
    const bool is_max = draw_coin(draws);
    (is_max ? ray.t_max : ray.t_min) = limit;
    return side == Side::on || (side == Side::above) == is_max;
}

/// Integers of at most 2^23: the ray meets the inside of a triangle at t = m 2^-j, exactly, or
/// with the limits scaled, m 2^(scale - j).
Triangle<float> lattice_ray(Draws& draws, RayCase& ray) {
    constexpr std::int64_t size = 1 << 10;
    const LatticeTriangle t = draw_around_origin(draws, size);
    const LatticeMap tilt = draw_tilt(draws, 1);
    const LatticePoint towards = draw_point(draws, {-size, -size, 1}, {size, size, size});
    const std::int64_t m = draw_integer(draws, 1, 255);
    const int j = static_cast<int>(draw_integer(draws, 0, 20));
    const auto placed = [&](LatticePoint p) { return Vec3<float>(to_scene(tilt(p), -20)); };
    ray.ray.origin = placed(-m * towards);
    ray.ray.direction = Vec3<float>(to_scene(tilt(towards), j - 20));
    const float exact = std::ldexp(static_cast<float>(m), -j);
    ray.hit = draw_limit(draws, exact, ray.ray) ? Known::yes : Known::no;
    return {placed(t[0]), placed(t[1]), placed(t[2])};
}

/// At any point well inside; t is no float, so that the nearest float may be on either side.
Triangle<float> rounded_ray(Draws& draws, RayCase& ray) {
    const Triangle<double> drawn = draw_triangle(draws);
    const Triangle<float> t{Vec3<float>(drawn.a), Vec3<float>(drawn.b), Vec3<float>(drawn.c)};
    const Vec3<double> direction = draws.unit_vector();
    ray.ray.direction = Vec3<float>(direction);
    ray.ray.origin = Vec3<float>(draw_inside(drawn, draws) - draws.uniform(1, 4) * direction);
    const Triangle<double> read{Vec3<double>(t.a), Vec3<double>(t.b), Vec3<double>(t.c)};
    const Vec3<double> n = normal_of(read);
    const double to =
        dot(read.a - Vec3<double>(ray.ray.origin), n) / dot(Vec3<double>(ray.ray.direction), n);
    draw_limit(draws, static_cast<float>(to), ray.ray);
    return t;
}

Cases rays_at_limits(const HardCaseSpec& spec, const Random& random) {
    RayCases cases;
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        RayCase& ray = cases.rays.emplace_back();
        const Triangle<float> t =
            draw_coin(draws) ? lattice_ray(draws, ray) : rounded_ray(draws, ray);
        cases.triangles.push_back(
            {scaled(t.a, spec.scale), scaled(t.b, spec.scale), scaled(t.c, spec.scale)});
        ray.first = static_cast<std::uint32_t>(i);
        ray.ray.origin = scaled(ray.ray.origin, spec.scale);
        for (float* limit : {&ray.ray.t_min, &ray.ray.t_max})
            *limit = std::ldexp(*limit, spec.scale);
    }
    return cases;
}

/// The ray enters the box at t = m 2^-j and leaves it at twice that, along one axis; along the
/// others it stays inside. A limit stands beside either.
RayBoxCase box_at_limit(Draws& draws, int scale) {
    RayBoxCase result;
    const auto along = static_cast<int>(draw_integer(draws, 0, 2));
    const auto m = static_cast<float>(draw_integer(draws, 1, 255));
    const int j = static_cast<int>(draw_integer(draws, 0, 20));
    const float sign = draw_coin(draws) ? 1 : -1;
    for (int axis = 0; axis < 3; ++axis) {
        const auto half = static_cast<float>(draw_integer(draws, 1, 1 << 20));
        result.box.min[axis] = -half;
        result.box.max[axis] = half;
        result.ray.direction[axis] = axis == along ? sign * std::ldexp(1.0f, j) : 0;
    }
    result.box.min[along] = sign > 0 ? m : -2 * m;
    result.box.max[along] = sign > 0 ? 2 * m : -m;
    const float entry = std::ldexp(m, -j);
    const bool is_max = draw_coin(draws);
    const auto side = static_cast<Side>(draw_integer(draws, 0, 2));
    if (is_max)
        result.ray.t_max = beside(entry, side);
    else
        result.ray.t_min = beside(2 * entry, side);
    result.hit = side == Side::on || (side == Side::above) == is_max ? Known::yes : Known::no;
    for (Vec3<float>* p : {&result.ray.origin, &result.box.min, &result.box.max})
        *p = scaled(*p, scale);
    for (float* limit : {&result.ray.t_min, &result.ray.t_max})
        *limit = std::ldexp(*limit, scale);
    return result;
}

} // namespace

HardCaseFamily ray_limits_family() {
    return {.name = "ray_limits",
            .summary = "t_min or t_max one float below t, on it or above, and farther off",
            .panel = Panel::touching,
            .scale_min = -80,
            .scale_max = 100,
            .generate = rays_at_limits};
}

HardCaseFamily ray_box_limits_family() {
    return {.name = "ray_box_limits",
            .summary = "t_max one float beside the t of entry, or t_min beside that of exit",
            .panel = Panel::touching,
            .scale_min = -80,
            .scale_max = 100,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                std::vector<RayBoxCase> cases(spec.n);
                for (std::size_t i = 0; i < spec.n; ++i) {
                    Draws draws = random.item(i);
                    cases[i] = box_at_limit(draws, spec.scale);
                }
                return Cases(std::move(cases));
            }};
}

} // namespace boxwood
