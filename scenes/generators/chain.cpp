#include "scenes/registry.h"
#include "scenes/robots/four_link.h"

namespace boxwood {
namespace {

/// The robot of four_link.h with n links: half a metre from joint to joint.
struct Chain {
    static constexpr std::string_view name = "chain";
    static constexpr std::string_view human_name = "straight arm of {n} links";
    static constexpr std::string_view summary =
        "the n link boxes of a straight arm, each overlapping its neighbours (overlaps unused)";
    static constexpr bool has_mesh = false, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        Scene scene;
        for (std::size_t i = 0; i < spec.n; ++i) {
            const Vec3<double> centre{.5 * static_cast<double>(i), 0, 0};
            scene.boxes.push_back({static_cast<Vec3<float>>(centre - four_link_half),
                                   static_cast<Vec3<float>>(centre + four_link_half)});
        }
        scene.params_json = "{}";
        return scene;
    }
};

} // namespace

SceneEntry chain_scene() { return scene_entry<Chain>(); }

} // namespace boxwood
