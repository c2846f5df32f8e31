#include "scenes/generators/octahedron_sphere.h"
#include "scenes/registry.h"
#include "scenes/sampling/lattice_noise.h"

#include <fmt/format.h>

namespace boxwood {
namespace {

constexpr int octaves = 4;
constexpr double frequency = 3;    ///< lattice cells per radius in the first octave
constexpr double amplitude = 0.15; ///< of the first octave; halved in each next one

/// Radius in (1 - amplitude, 1 + amplitude), so that the surface never meets itself.
double radius(const Random& random, Vec3<double> direction) {
    double sum = 1, size = amplitude, scale = frequency;
    for (int octave = 0; octave < octaves; ++octave, size /= 2, scale *= 2)
        sum += size * (lattice_noise(random, scale * direction) - 0.5);
    return sum;
}

/// A closed surface: a subdivided octahedron blown up to a sphere with a bumpy radius.
struct SphereMesh {
    static constexpr std::string_view name = "sphere_mesh";
    static constexpr std::string_view human_name = "sphere mesh, {n} triangles";
    static constexpr std::string_view summary =
        "a closed bumpy sphere of 8 f^2 triangles, f^2 nearest to n / 8";
    static constexpr bool has_mesh = true, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        const std::int64_t f = subdivision_of(spec, name);
        const Random random(spec.seed, name);
        Scene scene;
        scene.mesh = octahedron_sphere(
            f, [&](Vec3<double> direction) { return radius(random, direction) * direction; });
        scene.params_json =
            fmt::format(R"({{"subdivision":{},"octaves":{},"frequency":{},"amplitude":{}}})", f,
                        octaves, frequency, amplitude);
        return scene;
    }
};

} // namespace

SceneEntry sphere_mesh_scene() { return scene_entry<SphereMesh>(); }

} // namespace boxwood
