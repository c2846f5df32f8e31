#include "scenes/registry.h"
#include "scenes/sampling/random.h"

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

namespace boxwood {
namespace {

constexpr int octaves = 4;
constexpr double frequency = 3;    ///< lattice cells per radius in the first octave
constexpr double amplitude = 0.15; ///< of the first octave; halved in each next one

/// Smooth noise in [0, 1): random values at the integer points, blended by the cubic 3t^2 - 2t^3.
double lattice_noise(const Random& random, Vec3<double> p) {
    const Vec3<double> low{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const Vec3<double> t = p - low;
    const auto smooth = [](double u) { return u * u * (3 - 2 * u); };
    const Vec3<double> s{smooth(t.x), smooth(t.y), smooth(t.z)};
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        std::uint64_t item = 0;
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const int step = corner >> axis & 1;
            const auto coordinate = static_cast<std::int64_t>(low[axis]) + step + (1 << 20);
            item = item << 21 | static_cast<std::uint64_t>(coordinate);
            weight *= step ? s[axis] : 1 - s[axis];
        }
        sum += weight * random.item(item).uniform();
    }
    return sum;
}

/// Radius in (1 - amplitude, 1 + amplitude), so that the surface never meets itself.
double radius(const Random& random, Vec3<double> direction) {
    double sum = 1, size = amplitude, scale = frequency;
    for (int octave = 0; octave < octaves; ++octave, size /= 2, scale *= 2)
        sum += size * (lattice_noise(random, scale * direction) - 0.5);
    return sum;
}

/// The points with integer coordinates and |x| + |y| + |z| = f, numbered ring by ring from the top
/// (z = f): 4 r points in the ring of radius r = f - |z|, one at each pole, 4 f^2 + 2 in all.
struct OctahedronGrid {
    std::int64_t f;

    std::uint32_t index(std::int64_t x, std::int64_t y, std::int64_t z) const {
        const std::int64_t r = f - std::abs(z);
        // Before the ring of radius r > 0 of the upper half: the pole and 4 (1 + ... + (r - 1)).
        const std::int64_t total = 4 * f * f + 2;
        if (r == 0)
            return static_cast<std::uint32_t>(z > 0 ? 0 : total - 1);
        const std::int64_t ring = z >= 0 ? 1 + 2 * r * (r - 1) : total - 1 - 2 * r * (r + 1);
        const std::int64_t place = x > 0 && y >= 0   ? y
                                   : y > 0 && x <= 0 ? r - x
                                   : x < 0 && y <= 0 ? 2 * r - y
                                                     : 3 * r + x;
        return static_cast<std::uint32_t>(ring + place);
    }
};

/// A closed surface: a subdivided octahedron blown up to a sphere with a bumpy radius. Its 8 f^2
/// triangles wind counter-clockwise seen from outside.
struct SphereMesh {
    static constexpr std::string_view name = "sphere_mesh";
    static constexpr std::string_view human_name = "sphere mesh, {n} triangles";
    static constexpr std::string_view summary =
        "a closed bumpy sphere of 8 f^2 triangles, f^2 nearest to n / 8";
    static constexpr bool has_mesh = true, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        if (spec.n == 0 || spec.n > 0x7fffffff)
            throw std::invalid_argument(fmt::format(
                "scene sphere_mesh: n = {} triangles must lie in [1, 2147483647]", spec.n));
        const double wanted = std::sqrt(static_cast<double>(spec.n) / 8);
        const std::int64_t f = std::max<std::int64_t>(1, static_cast<std::int64_t>(wanted + 0.5));
        const OctahedronGrid grid{f};
        const Random random(spec.seed, name);
        Scene scene;
        scene.mesh.vertices.resize(static_cast<std::size_t>(4 * f * f + 2));
        scene.mesh.triangles.reserve(static_cast<std::size_t>(8 * f * f));
        for (int octant = 0; octant < 8; ++octant)
            add_octant(scene.mesh, grid, random, octant);
        scene.params_json =
            fmt::format(R"({{"subdivision":{},"octaves":{},"frequency":{},"amplitude":{}}})", f,
                        octaves, frequency, amplitude);
        return scene;
    }

    /// The vertices (those on the octant's rim again, to the same value) and the f^2 triangles.
    static void add_octant(TriangleMesh& mesh, OctahedronGrid grid, const Random& random,
                           int octant) {
        const std::int64_t f = grid.f;
        const std::int64_t sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1,
                           sz = octant & 4 ? -1 : 1;
        const bool mirrored = sx * sy * sz < 0;
        const auto at = [&](std::int64_t x, std::int64_t y) {
            return grid.index(sx * x, sy * y, sz * (f - x - y));
        };
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            mesh.triangles.push_back(mirrored ? std::array{a, c, b} : std::array{a, b, c});
        };
        for (std::int64_t x = 0; x <= f; ++x)
            for (std::int64_t y = 0; x + y <= f; ++y) {
                const Vec3<double> p{static_cast<double>(sx * x), static_cast<double>(sy * y),
                                     static_cast<double>(sz * (f - x - y))};
                const Vec3<double> direction = p * (1 / length(p));
                mesh.vertices[at(x, y)] =
                    static_cast<Vec3<float>>(radius(random, direction) * direction);
                if (x + y < f)
                    add(at(x, y), at(x + 1, y), at(x, y + 1));
                if (x + y + 1 < f)
                    add(at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
            }
    }
};

} // namespace

SceneEntry sphere_mesh_scene() { return scene_entry<SphereMesh>(); }

} // namespace boxwood
