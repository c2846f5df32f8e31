#include "scenes/robots/four_link.h"

#include "scenes/registry.h"

namespace boxwood {
namespace {

/// The robot of four_link.h with all its joints straight.
struct FourLink {
    static constexpr std::string_view name = "four_link";
    static constexpr std::string_view human_name = "robot arm of four links";
    static constexpr std::string_view summary = "the 4 link boxes of a straight robot arm, 2 "
                                                "overlapping pairs (n, seed and overlaps unused)";
    static constexpr bool has_mesh = false, uses_overlaps = false;

    static Scene generate(const SceneSpec&) {
        const auto boxes = four_link_straight_boxes();
        Scene scene;
        scene.boxes.assign(boxes.begin(), boxes.end());
        scene.params_json = "{}";
        return scene;
    }
};

} // namespace

SceneEntry four_link_scene() { return scene_entry<FourLink>(); }

} // namespace boxwood
