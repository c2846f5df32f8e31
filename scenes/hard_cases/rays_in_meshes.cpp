#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace boxwood {
namespace {

using Vec = Vec3<double>;
using Exponents = std::array<int, 3>;

/// Rays that share a mesh.
constexpr std::size_t rays_per_mesh = 32;
/// Origins are this close to the middle of a mesh whose vertices are 0.7 to 1.3 away, as seen from
/// there at most a right angle apart: its triangles are more than 0.7 / sqrt(3) = 0.4 away.
constexpr double inside = 0.25;

/// Places are multiples of this, so that floats hold them at any scale.
constexpr int grid_bits = 20, far_grid_bits = 12;
Vec on_grid(Vec p, int bits = grid_bits) {
    const auto rounded = [bits](double x) {
        return std::ldexp(std::floor(std::ldexp(x, bits) + .5), -bits);
    };
    return {rounded(p.x), rounded(p.y), rounded(p.z)};
}

struct Mesh {
    std::vector<Vec> vertices;
    std::vector<std::array<std::size_t, 3>> triangles;
    Vec centre{};
    int grid = grid_bits;
};

/// An octahedron, each triangle of which is cut in four up to two times, made rough.
Mesh draw_mesh(Draws& draws) {
    Mesh mesh;
    mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const std::size_t x : {0u, 1u})
        for (const std::size_t y : {2u, 3u})
            for (const std::size_t z : {4u, 5u})
                mesh.triangles.push_back({x, y, z});
    for (std::int64_t cuts = draw_integer(draws, 0, 2); cuts > 0; --cuts) {
        std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
        const auto middle = [&](std::size_t a, std::size_t b) {
            const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), mesh.vertices.size());
            if (is_new) {
                const Vec sum = mesh.vertices[a] + mesh.vertices[b];
                mesh.vertices.push_back(sum * (1 / length(sum)));
            }
            return at->second;
        };
        std::vector<std::array<std::size_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::size_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    for (Vec& vertex : mesh.vertices)
        vertex = on_grid(vertex * draws.uniform(.7, 1.3));
    return mesh;
}

Vec3<float> stretched(Vec p, const Exponents& by) {
    return Vec3<float>(Vec{std::ldexp(p.x, by[0]), std::ldexp(p.y, by[1]), std::ldexp(p.z, by[2])});
}

/// From the middle, or near it, at a vertex, an edge or anywhere, every fourth an ulp aside. Those
/// through the mesh come from four times as far on the other side: 1.5 to 6.5 away, so outside, and
/// pass by where the others begin, 0.15 and more inside.
Ray<float> draw_ray(const Mesh& mesh, const Exponents& by, bool is_through, Draws& draws) {
    const auto& [ia, ib, ic] = mesh.triangles[static_cast<std::size_t>(
        draw_integer(draws, 0, static_cast<std::int64_t>(mesh.triangles.size()) - 1))];
    const Vec a = mesh.vertices[ia], b = mesh.vertices[ib], c = mesh.vertices[ic];
    const double along = draw_coin(draws) ? .5 : draws.uniform();
    const Vec on_edge = a + along * (b - a);
    const std::int64_t kind = draw_integer(draws, 0, 3);
    const Vec target = kind == 0   ? a
                       : kind == 1 ? on_edge + draws.uniform() * (c - on_edge)
                                   : on_edge;
    const Vec middle =
        mesh.centre + (draw_coin(draws) ? on_grid(inside * draws.in_ball(), mesh.grid) : Vec{});
    const Vec3<float> origin =
        stretched(is_through ? middle - 4.0 * (on_grid(target) - middle) : middle, by);
    Ray<float> ray{origin, Vec3<float>(Vec(stretched(target, by)) - Vec(origin))};
    if (draw_integer(draws, 0, 3) == 0)
        for (int axis = 0; axis < 3; ++axis)
            ray.direction[axis] =
                std::nextafter(ray.direction[axis], draw_coin(draws) ? 0x1p126f : -0x1p126f);
    return ray;
}

/// Moved by up to 2^k, on a grid that leaves room for it.
void move_away(Mesh& mesh, int k, Draws& draws) {
    mesh.grid = far_grid_bits;
    mesh.centre = on_grid(std::ldexp(1.0, k) * draw_offset(draws), mesh.grid);
    for (Vec& vertex : mesh.vertices)
        vertex = mesh.centre + on_grid(vertex, mesh.grid);
}

enum class Around : std::uint8_t { origin, origin_from_outside, far_from_origin };

/// Axes are stretched by powers of two: all by 2^scale, one by 2^k more, one by 2^-k, and one by
/// something between them. Or, far from the origin, none.
Cases rays_in_meshes(const HardCaseSpec& spec, const Random& random,
                     Around around = Around::origin) {
    const bool is_through = around == Around::origin_from_outside;
    RayCases cases;
    Mesh mesh;
    Exponents by{};
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        if (i % rays_per_mesh == 0) {
            mesh = draw_mesh(draws);
            const int k = around == Around::far_from_origin ? 0 : *spec.k;
            if (around == Around::far_from_origin)
                move_away(mesh, *spec.k, draws);
            by = {k, -k, static_cast<int>(draw_integer(draws, -k, k))};
            shuffle(by, draws);
        }
        RayCase& ray = cases.rays.emplace_back();
        ray.ray = draw_ray(mesh, by, is_through, draws);
        ray.ray.origin = scaled(ray.ray.origin, spec.scale);
        ray.count = static_cast<std::uint32_t>(mesh.triangles.size());
        ray.hit = Known::yes;
        if (i % rays_per_mesh != 0) {
            ray.first = cases.rays[i - 1].first;
            continue;
        }
        ray.first = static_cast<std::uint32_t>(cases.triangles.size());
        const auto corner = [&](std::size_t vertex) {
            return scaled(stretched(mesh.vertices[vertex], by), spec.scale);
        };
        for (const auto& [a, b, c] : mesh.triangles)
            cases.triangles.push_back({corner(a), corner(b), corner(c)});
    }
    return cases;
}

} // namespace

/// Scales: coordinates below 1.3 2^125 and multiples of 2^-149.
HardCaseFamily ray_in_mesh_family() {
    return {.name = "ray_in_mesh",
            .summary = "rays from inside closed meshes, coordinates up to 2^126; they must hit",
            .panel = Panel::touching,
            .scale_min = grid_bits - 149,
            .scale_max = 125,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                HardCaseSpec round = spec;
                round.k = 0;
                return rays_in_meshes(round, random);
            }};
}

/// Scales: coordinates below 2^11 + 2.
HardCaseFamily ray_in_far_mesh_family() {
    return {.name = "ray_in_far_mesh",
            .summary = "rays from inside closed meshes far from the origin; they must hit",
            .panel = Panel::touching,
            .k_meaning = "the mesh is up to 2^k of its size from the origin",
            .k_default = 8,
            .k_min = 0,
            .k_max = 11,
            .scale_min = far_grid_bits - 149,
            .scale_max = 114,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                return rays_in_meshes(spec, random, Around::far_from_origin);
            }};
}

/// Scales: coordinates below 6.5 2^123.
HardCaseFamily ray_through_mesh_family() {
    return {.name = "ray_through_mesh",
            .summary = "rays through closed meshes, in and out again; they must hit",
            .panel = Panel::touching,
            .scale_min = grid_bits - 149,
            .scale_max = 123,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                HardCaseSpec round = spec;
                round.k = 0;
                return rays_in_meshes(round, random, Around::origin_from_outside);
            }};
}

HardCaseFamily ray_in_stretched_mesh_family() {
    return {.name = "ray_in_stretched_mesh",
            .summary = "rays from inside closed meshes 4^k as long as wide; they must hit",
            .panel = Panel::degenerate,
            .k_meaning = "axes are stretched by 2^-k to 2^k",
            .k_default = 100,
            .k_min = 0,
            .k_max = 100,
            .scale_min = grid_bits + 100 - 149,
            .scale_max = 25,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                return rays_in_meshes(spec, random);
            }};
}

} // namespace boxwood
