#include "scenes/generators/octahedron_sphere.h"
#include "scenes/registry.h"

#include <fmt/format.h>

namespace boxwood {
namespace {

/// Every place of its surface is equally far from a sphere around it.
struct SmoothSphere {
    static constexpr std::string_view name = "smooth_sphere";
    static constexpr std::string_view human_name = "smooth sphere, {n} triangles";
    static constexpr std::string_view summary =
        "a closed sphere of radius 1, of 8 f^2 triangles, f^2 nearest to n / 8 (seed unused)";
    static constexpr bool has_mesh = true, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        const std::int64_t f = subdivision_of(spec, name);
        Scene scene;
        scene.mesh = octahedron_sphere(f, [](Vec3<double> direction) { return direction; });
        scene.params_json = fmt::format(R"({{"subdivision":{}}})", f);
        return scene;
    }
};

} // namespace

SceneEntry smooth_sphere_scene() { return scene_entry<SmoothSphere>(); }

} // namespace boxwood
