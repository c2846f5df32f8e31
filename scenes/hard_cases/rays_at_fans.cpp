#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

#include <cstddef>

namespace boxwood {
namespace {

/// Rays and fans are built around the origin, where the ray passes, in the basis (x, y / 2^k, D):
/// seen along the ray's direction D the triangles cover a disc around the origin, whatever their
/// heights along D. Sizes are integers below 2^24 after the tilt, so that floats hold them all.
constexpr int fan_size_bits = 20, fan_k_max = 12;
constexpr std::int64_t fan_size =
    1 << 18; ///< of a fan across the ray; squeezed to fan_size / 2^k in y

struct Fan {
    std::vector<LatticePoint> corners; ///< x, y, height; the ray is aimed at [0] or between 0 and 1
    std::vector<std::array<std::size_t, 3>> triangles;
    bool aims_at_edge = false;
};

/// Three to eight triangles around the origin. Among the eight compass points numbers 0, 3 and 5
/// are always there, so that no two neighbours are half a turn or more apart.
Fan draw_vertex_fan(Draws& draws) {
    constexpr std::int64_t compass[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                            {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    Fan fan{{LatticePoint{}}, {}, false};
    for (std::size_t i = 0; i < 8; ++i)
        if (i == 0 || i == 3 || i == 5 || draw_coin(draws)) {
            const std::int64_t radius = draw_integer(draws, fan_size / 2, fan_size);
            const std::int64_t height = draw_integer(draws, -6, 6);
            fan.corners.push_back({radius * compass[i][0], radius * compass[i][1], height});
        }
    for (std::size_t i = 1; i < fan.corners.size(); ++i)
        fan.triangles.push_back({0, i, i % (fan.corners.size() - 1) + 1});
    return fan;
}

/// Two triangles on both sides of an edge through the origin.
Fan draw_edge_fan(Draws& draws) {
    const LatticePoint step{draw_integer(draws, fan_size / 8, fan_size / 4), 0,
                            draw_integer(draws, -1, 1)};
    const std::int64_t back = draw_integer(draws, 2, 4), forth = draw_integer(draws, 2, 4);
    const auto side = [&](std::int64_t sign) {
        return LatticePoint{draw_integer(draws, -fan_size / 4, fan_size / 4),
                            sign * draw_integer(draws, fan_size / 2, fan_size),
                            draw_integer(draws, -6, 6)};
    };
    const LatticePoint left = side(1), right = side(-1);
    return {{-back * step, forth * step, left, right}, {{0, 1, 2}, {1, 0, 3}}, true};
}

/// Every other ray goes through the origin exactly, as direction = - D. In the other cases all
/// corners are multiplied by a factor that fills their last bits and are rounded to float, and so
/// is the direction to the corner or to a point of the edge. On each axis that displaces the ray by
/// 1 unit, the corners by 1, and those off the target's height by 2 more; seen along D, before the
/// tilt, by at most (1 + 4) 16 4 = 320, as |D| <= 4 |D.z| and the inverse of the tilt grows by 16;
/// in y before the squeeze by 320 2^5. The disc reaches 2^15 2 / sqrt(29) > 12000.
constexpr int k_rounded = 5; ///< thinner fans get exact rays alone

template <Fan (*draw_fan)(Draws&)> Cases rays_at(const HardCaseSpec& spec, const Random& random) {
    RayCases cases;
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        const LatticePoint along =
            draw_point(draws, {-65535, -65535, 16384}, {65535, 65535, 65535});
        const Fan fan = draw_fan(draws);
        const LatticeMap tilt = draw_tilt(draws, 1);
        const LatticePoint shift = draw_point(draws, {-2 * fan_size, -2 * fan_size, -2 * fan_size},
                                              {2 * fan_size, 2 * fan_size, 2 * fan_size});
        const bool is_exact = draw_coin(draws) || *spec.k > k_rounded;
        const double factor =
            is_exact ? 1 : 1 + static_cast<double>(draw_integer(draws, 1, 255)) / 256;
        const auto placed = [&](LatticePoint p) {
            return Vec3<float>(factor * to_scene(tilt(p + shift), -fan_size_bits));
        };
        const auto corner = [&](std::size_t c) {
            const LatticePoint p = fan.corners[c];
            return placed(LatticePoint{p.x, p.y / (1 << *spec.k), 0} + p.z * along);
        };
        RayCase& ray = cases.rays.emplace_back();
        ray.first = static_cast<std::uint32_t>(cases.triangles.size());
        ray.count = static_cast<std::uint32_t>(fan.triangles.size());
        ray.hit = Known::yes;
        for (const auto& [a, b, c] : fan.triangles)
            cases.triangles.push_back({scaled(corner(a), spec.scale), scaled(corner(b), spec.scale),
                                       scaled(corner(c), spec.scale)});
        const Vec3<float> origin = placed(draw_integer(draws, 7, 16) * along);
        ray.ray.origin = scaled(origin, spec.scale);
        if (is_exact) {
            ray.ray.direction = Vec3<float>(to_scene(tilt(-along), -16));
        } else {
            const auto a = Vec3<double>(corner(0)), b = Vec3<double>(corner(1));
            const double share = fan.aims_at_edge ? draws.uniform(0.25, 0.75) : 0;
            ray.ray.direction = Vec3<float>(a + share * (b - a) - Vec3<double>(origin));
        }
    }
    return cases;
}

HardCaseFamily fan_family(std::string_view name, std::string_view summary,
                          decltype(HardCaseFamily::generate) generate) {
    return {.name = name,
            .summary = summary,
            .panel = Panel::touching,
            .k_meaning =
                "the fan is 2^-k as wide as long; above 5 all rays pass through it exactly",
            .k_default = 0,
            .k_min = 0,
            .k_max = fan_k_max,
            .scale_min = -149 + fan_size_bits + 8,
            .scale_max = 120,
            .generate = generate};
}

} // namespace

HardCaseFamily ray_through_edge_family() {
    return fan_family("ray_through_edge",
                      "rays at the shared edge of two triangles; they must hit one",
                      rays_at<draw_edge_fan>);
}

HardCaseFamily ray_through_vertex_family() {
    return fan_family("ray_through_vertex",
                      "rays at the middle of a closed fan of triangles; they must hit one",
                      rays_at<draw_vertex_fan>);
}

} // namespace boxwood
