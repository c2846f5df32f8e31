#include "scenes/hard_cases/lattice.h"

#include <cstddef>

namespace boxwood {
namespace {

/// Rays and fans are built around the origin, where the ray passes exactly, in the basis
/// (x, y / 2^k, D): seen along the ray's direction D the triangles cover a disc around the origin,
/// whatever their heights along D. Sizes are integers of at most 2^18, so floats hold them all.
constexpr int size_bits = 12, k_most = 8;
constexpr std::int64_t size = 1 << 10; ///< of a fan across the ray; squeezed to size / 2^k in y

struct Fan {
    std::vector<LatticePoint> corners; ///< x, y, height
    std::vector<std::array<std::size_t, 3>> triangles;
};

/// Three to eight triangles around the origin. Among the eight compass points numbers 0, 3 and 5
/// are always there, so that no two neighbours are half a turn or more apart.
Fan draw_vertex_fan(Draws& draws) {
    constexpr std::int64_t compass[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                            {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    Fan fan{{LatticePoint{}}, {}};
    for (std::size_t i = 0; i < 8; ++i)
        if (i == 0 || i == 3 || i == 5 || draw_coin(draws)) {
            const std::int64_t radius = draw_integer(draws, size / 2, size);
            const std::int64_t height = draw_integer(draws, -6, 6);
            fan.corners.push_back({radius * compass[i][0], radius * compass[i][1], height});
        }
    for (std::size_t i = 1; i < fan.corners.size(); ++i)
        fan.triangles.push_back({0, i, i % (fan.corners.size() - 1) + 1});
    return fan;
}

/// Two triangles on both sides of an edge through the origin.
Fan draw_edge_fan(Draws& draws) {
    const LatticePoint step{draw_integer(draws, size / 4, size / 2), 0, draw_integer(draws, -3, 3)};
    const std::int64_t back = draw_integer(draws, 1, 2), forth = draw_integer(draws, 1, 2);
    const auto side = [&](std::int64_t sign) {
        return LatticePoint{draw_integer(draws, -size / 2, size / 2),
                            sign * draw_integer(draws, size / 2, size), draw_integer(draws, -6, 6)};
    };
    const LatticePoint left = side(1), right = side(-1);
    return {{-back * step, forth * step, left, right}, {{0, 1, 2}, {1, 0, 3}}};
}

/// Every other ray goes through the origin exactly, as direction = - D. The others have a direction
/// of any length, rounded: from at most 6 16 255 units away they miss the origin by 2^-9 on each
/// axis, by 16 2^-9 before the tilt, and seen along D by (1 + 255 / 64) 2^-5 < 0.2; while the disc
/// of a fan reaches 0.5 even at k = 8, where its corners have |y| >= 2 or y = 0.
template <Fan (*draw_fan)(Draws&)> Cases rays_at(const HardCaseSpec& spec, const Random& random) {
    RayCases cases;
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        const LatticePoint along = draw_point(draws, {-255, -255, 64}, {255, 255, 255});
        const Fan fan = draw_fan(draws);
        const LatticeMap tilt = draw_tilt(draws, 1);
        const LatticePoint shift =
            draw_point(draws, {-2 * size, -2 * size, -2 * size}, {2 * size, 2 * size, 2 * size});
        const auto placed = [&](LatticePoint p) {
            return Vec3<float>(to_scene(tilt(p + shift), spec.scale - size_bits));
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
            cases.triangles.push_back({corner(a), corner(b), corner(c)});
        ray.ray.origin = placed(draw_integer(draws, 7, 16) * along);
        const Vec3<double> direction = to_scene(tilt(-along), -8);
        ray.ray.direction =
            Vec3<float>(draw_coin(draws) ? direction : draws.uniform(0.5, 2) * direction);
    }
    return cases;
}

HardCaseFamily family(std::string_view name, std::string_view summary,
                      decltype(HardCaseFamily::generate) generate) {
    return {.name = name,
            .summary = summary,
            .panel = Panel::touching,
            .k_meaning = "the fan is 2^-k as wide as long",
            .k_default = 0,
            .k_least = 0,
            .k_most = k_most,
            .scale_least = -149 + size_bits,
            .scale_most = 120,
            .generate = generate};
}

} // namespace

HardCaseFamily ray_through_edge_family() {
    return family("ray_through_edge", "rays at the shared edge of two triangles; they must hit one",
                  rays_at<draw_edge_fan>);
}

HardCaseFamily ray_through_vertex_family() {
    return family("ray_through_vertex",
                  "rays at the middle of a closed fan of triangles; they must hit one",
                  rays_at<draw_vertex_fan>);
}

} // namespace boxwood
