/// A surface such as scanners leave. In: n, seed. Steps: directions of an octahedron's grid drawn
/// together around some centres; a radius with bumps; what a scanner errs by; holes where it did
/// not see. Out: an open mesh of nearly n triangles, in no part alike.

#include "scenes/generators/octahedron_sphere.h"
#include "scenes/registry.h"
#include "scenes/sampling/lattice_noise.h"

#include <fmt/format.h>

#include <vector>

namespace boxwood {
namespace {

using Vec = Vec3<double>;

constexpr int n_dense = 8, n_bumps = 12, n_holes = 9;
constexpr double noise = 0.15;             ///< of the mean edge, along the ray that was measured
constexpr double hole_frequency = 12;      ///< lattice cells per radius of the holes' ragged rims
constexpr std::int64_t min_with_holes = 8; ///< subdivision

/// What lies around a direction.
struct Spot {
    Vec centre;
    double reach, strength;

    /// 1 in the middle, a quarter at the reach.
    double weight(Vec direction) const {
        const Vec apart = direction - centre;
        const double x = 1 + dot(apart, apart) / (reach * reach);
        return 1 / (x * x);
    }
};

std::vector<Spot> spots(const Random& random, int n, double low, double high, double weakest,
                        double strongest) {
    std::vector<Spot> all;
    for (int i = 0; i < n; ++i) {
        Draws draws = random.item(static_cast<std::uint64_t>(i));
        const Vec centre = draws.unit_vector();
        const double reach = draws.uniform(low, high);
        all.push_back({centre, reach, draws.uniform(weakest, strongest)});
    }
    return all;
}

class Scanned {
  public:
    Scanned(std::uint64_t seed, std::int64_t f)
        : dense_(spots({seed, "scan_mesh_dense"}, n_dense, .2, .6, .7, .9)),
          bumps_(spots({seed, "scan_mesh_bumps"}, n_bumps, .1, .5, -.15, .4)),
          holes_(spots({seed, "scan_mesh_holes"}, n_holes, .05, .2, 0, 0)),
          errors_(seed, "scan_mesh_errors"), rims_(seed, "scan_mesh_rims"),
          error_(noise / static_cast<double>(f)) {}

    Vec place(Vec direction) const {
        for (const Spot& spot : dense_)
            direction =
                direction + spot.strength * spot.weight(direction) * (spot.centre - direction);
        direction = direction * (1 / length(direction));
        double radius = 1;
        for (const Spot& spot : bumps_)
            radius += spot.strength * spot.weight(direction);
        return radius * direction;
    }
    Vec with_error(std::uint64_t vertex, Vec p) const {
        return (1 + error_ * (2 * errors_.item(vertex).uniform() - 1)) * p;
    }
    bool is_seen(Vec p) const {
        const Vec direction = p * (1 / length(p));
        const double ragged = .6 + .8 * lattice_noise(rims_, hole_frequency * direction);
        return std::ranges::none_of(holes_, [&](const Spot& hole) {
            return length(direction - hole.centre) < ragged * hole.reach;
        });
    }

  private:
    std::vector<Spot> dense_, bumps_, holes_;
    Random errors_, rims_;
    double error_;
};

/// Without the vertices that no triangle names.
TriangleMesh compacted(const TriangleMesh& mesh) {
    constexpr std::uint32_t none = ~0u;
    std::vector<std::uint32_t> number(mesh.vertices.size(), none);
    TriangleMesh compact;
    for (auto triangle : mesh.triangles) {
        for (std::uint32_t& v : triangle) {
            if (number[v] == none) {
                number[v] = static_cast<std::uint32_t>(compact.vertices.size());
                compact.vertices.push_back(mesh.vertices[v]);
            }
            v = number[v];
        }
        compact.triangles.push_back(triangle);
    }
    return compact;
}

struct ScanMesh {
    static constexpr std::string_view name = "scan_mesh";
    static constexpr std::string_view human_name = "scan-like mesh, {n} triangles";
    static constexpr std::string_view summary =
        "an open surface such as scanners leave, of nearly n triangles: dense in places and coarse "
        "in others, with bumps, noise and ragged holes";
    static constexpr bool has_mesh = true, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        const std::int64_t f = subdivision_of(spec, name);
        const Scanned scanned(spec.seed, f);
        Scene scene;
        scene.mesh = octahedron_sphere(f, [&](Vec direction) { return scanned.place(direction); });
        std::vector<std::uint8_t> is_seen;
        for (std::size_t i = 0; i < scene.mesh.vertices.size(); ++i) {
            const Vec p(scene.mesh.vertices[i]);
            is_seen.push_back(f < min_with_holes || scanned.is_seen(p));
            scene.mesh.vertices[i] = static_cast<Vec3<float>>(scanned.with_error(i, p));
        }
        std::erase_if(scene.mesh.triangles, [&](const auto& triangle) {
            return std::ranges::any_of(triangle, [&](std::uint32_t v) { return !is_seen[v]; });
        });
        scene.mesh = compacted(scene.mesh);
        scene.params_json =
            fmt::format(R"({{"subdivision":{},"dense":{},"bumps":{},"holes":{},"noise":{}}})", f,
                        n_dense, n_bumps, n_holes, noise);
        return scene;
    }
};

} // namespace

SceneEntry scan_mesh_scene() { return scene_entry<ScanMesh>(); }

} // namespace boxwood
