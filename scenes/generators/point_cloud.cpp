#include "scenes/registry.h"
#include "scenes/sampling/random.h"

namespace boxwood {
namespace {

/// Points, as libraries of k-d trees have them.
struct PointCloud {
    static constexpr std::string_view name = "point_cloud";
    static constexpr std::string_view human_name = "{n} points";
    static constexpr std::string_view summary =
        "n points uniform in the unit cube, as boxes of no size (overlaps unused)";
    static constexpr bool has_mesh = false, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        const Random random(spec.seed, name);
        Scene scene;
        scene.boxes.reserve(spec.n);
        for (std::size_t i = 0; i < spec.n; ++i) {
            const auto point = static_cast<Vec3<float>>(random.item(i).in_cube());
            scene.boxes.push_back({point, point});
        }
        scene.params_json = "{}";
        return scene;
    }
};

} // namespace

SceneEntry point_cloud_scene() { return scene_entry<PointCloud>(); }

} // namespace boxwood
