#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

#include <array>
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

/// Sides are powers of two, so that in `Watertight` too nothing rounds: a ray along an axis, from
/// within or from the wall that it leaves by, and a limit or both at t or one float off.
RayCase ray_in_cuboid(Draws& draws, std::array<Triangle<float>, 12>& walls, int scale) {
    RayCase result;
    LatticePoint low, side, at; // in eighths
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = 8 * draw_integer(draws, -8, 8);
        side[axis] = std::int64_t{8} << draw_integer(draws, 0, 4);
        at[axis] = low[axis] + side[axis] / 8 * draw_integer(draws, 1, 7);
    }
    const auto along = static_cast<int>(draw_integer(draws, 0, 2));
    const bool is_up = draw_coin(draws);
    const std::int64_t wall = low[along] + (is_up ? side[along] : 0);
    if (draw_integer(draws, 0, 3) == 0)
        at[along] = wall;
    const auto j = static_cast<int>(draw_integer(draws, 0, 20));
    result.ray.origin = scaled(Vec3<float>(to_scene(at, -3)), scale);
    result.ray.direction[along] = std::ldexp(is_up ? 1.f : -1.f, j);
    const float t = std::ldexp(static_cast<float>(std::abs(wall - at[along])), scale - 3 - j);
    const std::int64_t limits = draw_integer(draws, 0, 3);
    if (limits != 0)
        result.ray.t_max = t;
    if (limits != 1)
        result.ray.t_min = t;
    result.hit = Known::yes;
    if (limits == 3) {
        const bool is_max = t > 0 && draw_coin(draws);
        (is_max ? result.ray.t_max : result.ray.t_min) =
            beside(t, is_max ? Side::below : Side::above);
        result.hit = Known::no;
    }
    result.count = 12;
    for (std::size_t i = 0; i < 12; ++i) {
        const auto axis = static_cast<int>(i / 4), x = (axis + 1) % 3, y = (axis + 2) % 3;
        const auto corner = [&](bool right, bool up) {
            LatticePoint p = low;
            p[axis] += i % 4 / 2 == 0 ? 0 : side[axis];
            p[x] += right ? side[x] : 0;
            p[y] += up ? side[y] : 0;
            return scaled(Vec3<float>(to_scene(p, -3)), scale);
        };
        walls[i] = {corner(false, false), corner(true, true), corner(i % 2 == 0, i % 2 != 0)};
    }
    return result;
}

Cases rays_at_exact_limits(const HardCaseSpec& spec, const Random& random) {
    RayCases cases;
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        std::array<Triangle<float>, 12> walls;
        cases.rays.push_back(ray_in_cuboid(draws, walls, spec.scale));
        cases.rays.back().first = static_cast<std::uint32_t>(cases.triangles.size());
        cases.triangles.insert(cases.triangles.end(), walls.begin(), walls.end());
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

HardCaseFamily ray_at_exact_limits_family() {
    return {.name = "ray_at_exact_limits",
            .summary = "rays along an axis in a cuboid; t, which no kernel rounds, is a limit",
            .panel = Panel::touching,
            .scale_min = -80,
            .scale_max = 100,
            .generate = rays_at_exact_limits};
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
