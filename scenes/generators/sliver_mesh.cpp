#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

namespace boxwood {
namespace {

/// Triangles that nearly all of their boxes is empty of: hard on every tree of boxes.
struct SliverMesh {
    static constexpr std::string_view name = "sliver_mesh";
    static constexpr std::string_view human_name = "{n} sliver triangles";
    static constexpr std::string_view summary =
        "n unconnected triangles, long and thin (100:1), in random directions in the unit cube";
    static constexpr bool has_mesh = true, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        return scattered_triangles(spec, name, [](Draws& draws) {
            const Vec3<double> along = draws.unit_vector(), aside = draws.unit_vector();
            return Corners{along, -1.0 * along, along + 0.02 * aside};
        });
    }
};

} // namespace

SceneEntry sliver_mesh_scene() { return scene_entry<SliverMesh>(); }

} // namespace boxwood
