#include "scenes/sampling/rays.h"

#include "kernels/arithmetic/rounding.h"
#include "kernels/suggest.h"
#include "scenes/sampling/random.h"
#include "scenes/scene.h"
#include "scenes/text/csv.h"
#include "scenes/text/read_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

using Vec = Vec3<double>;

Vec normalized(Vec v) { return v * (1 / length(v)); }

/// A mesh seen by those who shoot at it: its bounding sphere, and a way to pick surface points.
struct Target {
    const TriangleMesh& mesh;
    std::uint64_t seed;
    std::size_t n;
    Vec centre{};
    double radius = 0;                  ///< half the diagonal of the box, or 1 if that is 0
    double offset = 0;                  ///< leaves a surface safely, also far from the origin
    std::vector<double> areas_so_far{}; ///< running sum of twice the triangles' areas

    Target(const TriangleMesh& m, std::size_t n_rays, std::uint64_t key)
        : mesh(m), seed(key), n(n_rays) {
        Aabb<double> box;
        for (const auto& t : mesh.triangles)
            for (const std::uint32_t v : t)
                box.extend(static_cast<Vec>(mesh.vertices[v]));
        centre = 0.5 * (box.min + box.max);
        radius = 0.5 * length(box.max - box.min);
        if (!(radius > 0))
            radius = 1;
        double largest = 0;
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max({largest, std::abs(box.min[axis]), std::abs(box.max[axis])});
        offset = std::max(1e-4 * radius, 0x1p-20 * largest); // at least 8 ulp of any coordinate
    }

    void sum_areas() {
        areas_so_far.reserve(mesh.triangles.size());
        double sum = 0;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
            areas_so_far.push_back(sum += length(normal(i)));
    }

    /// Of twice the triangle's area as length; counter-clockwise seen from its tip.
    Vec normal(std::size_t i) const {
        const Triangle<float> t = mesh.triangle(i);
        const Vec a = static_cast<Vec>(t.a);
        return cross(static_cast<Vec>(t.b) - a, static_cast<Vec>(t.c) - a);
    }

    struct SurfacePoint {
        Vec point, normal;
    };
    /// Uniform on the surface. Where all triangles are degenerate, uniform among them, with a
    /// random normal.
    SurfacePoint surface_point(Draws& draws) const {
        const double total = areas_so_far.back();
        const double pick = draws.uniform();
        std::size_t i;
        if (total > 0) {
            const auto found =
                std::upper_bound(areas_so_far.begin(), areas_so_far.end(), pick * total);
            i = static_cast<std::size_t>(found - areas_so_far.begin());
        } else {
            i = static_cast<std::size_t>(pick * static_cast<double>(areas_so_far.size()));
        }
        i = std::min(i, areas_so_far.size() - 1);
        const Triangle<float> t = mesh.triangle(i);
        double u = draws.uniform(), v = draws.uniform();
        if (u + v > 1) { // the other half of the parallelogram, turned onto this one
            u = 1 - u;
            v = 1 - v;
        }
        const Vec a = static_cast<Vec>(t.a), b = static_cast<Vec>(t.b), c = static_cast<Vec>(t.c);
        const Vec across = normal(i);
        return {a + u * (b - a) + v * (c - a),
                length(across) > 0 ? normalized(across) : draws.unit_vector()};
    }
};

Ray<float> to_float(Vec origin, Vec direction) {
    return {static_cast<Vec3<float>>(origin), static_cast<Vec3<float>>(direction)};
}

/// A pinhole camera in front, to the right and above that sees the whole bounding sphere: from 2.5
/// radii away the sphere fills a cone of slope 1 / sqrt(2.5^2 - 1) < 0.44.
std::vector<Ray<float>> primary(const Target& target) {
    const Vec backward = normalized({0.6, 0.5, 1});
    const Vec eye = target.centre + 2.5 * target.radius * backward;
    const Vec right = normalized(cross({0, 1, 0}, backward));
    const Vec up = cross(backward, right);
    const std::size_t side = picture_width("primary", target.n);
    const double step = 2 * 0.44 / static_cast<double>(side);
    std::vector<Ray<float>> rays;
    rays.reserve(target.n);
    for (std::size_t i = 0; i < target.n; ++i) {
        const double x = (static_cast<double>(i % side) + 0.5) * step - 0.44;
        const double y = 0.44 - (static_cast<double>(i / side) + 0.5) * step;
        rays.push_back(to_float(eye, normalized(x * right + y * up - backward)));
    }
    return rays;
}

std::vector<Ray<float>> random(const Target& target) {
    const Random numbers(target.seed, "rays.random");
    std::vector<Ray<float>> rays;
    rays.reserve(target.n);
    for (std::size_t i = 0; i < target.n; ++i) {
        Draws draws = numbers.item(i);
        const Vec from = draws.unit_vector();
        Vec across;
        do
            across = draws.in_ball() - from;
        while (dot(across, across) < 0x1p-20);
        rays.push_back(to_float(target.centre + target.radius * from, normalized(across)));
    }
    return rays;
}

/// The sum of the normal and a uniform unit vector has a cosine-weighted direction.
std::vector<Ray<float>> ambient(const Target& target) {
    const Random numbers(target.seed, "rays.ambient");
    std::vector<Ray<float>> rays;
    rays.reserve(target.n);
    for (std::size_t i = 0; i < target.n; ++i) {
        Draws draws = numbers.item(i);
        const auto [point, normal] = target.surface_point(draws);
        Vec direction;
        do
            direction = normal + draws.unit_vector();
        while (dot(direction, direction) < 0x1p-20);
        rays.push_back(to_float(point + target.offset * normal, normalized(direction)));
        rays.back().t_max = static_cast<float>(target.radius);
    }
    return rays;
}

/// The light stands outside the bounding sphere; the points are on the side of their triangle that
/// faces it. The direction is not normalised: the light is at t = 1.
std::vector<Ray<float>> occlusion(const Target& target) {
    const Random numbers(target.seed, "rays.occlusion");
    const Vec light = target.centre + 2 * target.radius * normalized({-0.4, 1, 0.3});
    std::vector<Ray<float>> rays;
    rays.reserve(target.n);
    for (std::size_t i = 0; i < target.n; ++i) {
        Draws draws = numbers.item(i);
        const auto [point, normal] = target.surface_point(draws);
        const double facing = dot(light - point, normal) < 0 ? -1 : 1;
        const Vec origin = point + (facing * target.offset) * normal;
        rays.push_back(to_float(origin, light - origin));
        rays.back().t_max = 1;
    }
    return rays;
}

#define BOXWOOD_RAY_KINDS(X)                                                                       \
    X(primary, "a pinhole camera's rays, row by row: coherent")                                    \
    X(random, "from the bounding sphere toward points inside: incoherent")                         \
    X(ambient, "from the surface into its hemisphere, cosine-weighted, as far as the radius")      \
    X(occlusion, "from the surface to one light point: for rays_any")

} // namespace

std::span<const RayKindEntry> ray_kinds() {
#define BOXWOOD_ROW(name, summary) {#name, summary},
    static constexpr RayKindEntry entries[] = {BOXWOOD_RAY_KINDS(BOXWOOD_ROW)};
#undef BOXWOOD_ROW
    return entries;
}

std::size_t picture_width(std::string_view kind, std::size_t n) {
    return kind == "primary"
               ? static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(n))))
               : 0;
}

void check_ray_kind(std::string_view kind) { entry_named(kind, ray_kinds(), "kind of rays"); }

std::vector<Ray<float>> make_rays(std::string_view kind, const TriangleMesh& mesh, std::size_t n,
                                  std::uint64_t seed) {
    check_ray_kind(kind);
    if (mesh.triangles.empty())
        throw std::invalid_argument("rays: the mesh has no triangles to aim at");
    Target target(mesh, n, seed);
    target.sum_areas();
    std::vector<Ray<float>> rays;
#define BOXWOOD_MAKE(name, summary)                                                                \
    if (kind == #name)                                                                             \
        rays = name(target);
    BOXWOOD_RAY_KINDS(BOXWOOD_MAKE)
#undef BOXWOOD_MAKE
    for (const Ray<float>& ray : rays)
        if (const Vec3<float> o = ray.origin;
            !(std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)}) < max_ray_coordinate) ||
            !is_finite(ray.direction))
            throw std::runtime_error(
                "rays: at this mesh some would start at coordinates that are not "
                "below 2^126 (8.5e37) in size, or have a direction beyond "
                "floats: scale the mesh down");
    return rays;
}

std::vector<Ray<float>> parse_rays(std::string_view text, const std::string& source) {
    constexpr std::array names{"ox", "oy", "oz", "dx", "dy", "dz"};
    std::vector<Ray<float>> rays;
    const auto take = [&](std::span<const double> v, std::size_t line) {
        for (std::size_t i = 0; i < 6; ++i)
            if (!(std::abs(static_cast<float>(v[i])) < max_ray_coordinate))
                throw_bad_row(source, line,
                              fmt::format("{} is {}; a ray needs finite numbers below 2^126 "
                                          "(8.5e37) in size",
                                          names[i], v[i]));
        Ray<float> ray = to_float({v[0], v[1], v[2]}, {v[3], v[4], v[5]});
        if (ray.direction == Vec3<float>{})
            throw_bad_row(source, line,
                          "the direction dx,dy,dz is zero as floats; a ray needs one, of any "
                          "length above 1e-45");
        if (v.size() == 7) {
            if (!(v[6] >= 0))
                throw_bad_row(
                    source, line,
                    fmt::format("tmax is {}; it must be 0 or more (or be left out)", v[6]));
            ray.t_max = round_down(v[6]);
        }
        rays.push_back(ray);
    };
    read_csv(text, source, {ray_columns, 6, 7}, take);
    return rays;
}

std::vector<Ray<float>> read_rays(const std::filesystem::path& file) {
    std::vector<Ray<float>> rays = parse_rays(read_file(file), file.string());
    if (rays.empty())
        throw BadInput(fmt::format("{}: it holds no rows of {}", file.string(), ray_columns));
    return rays;
}

} // namespace boxwood
