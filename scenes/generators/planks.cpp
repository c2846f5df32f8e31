#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

namespace boxwood {
namespace {

/// Planks about 20 times as long and wide as thick, one third across each axis.
struct Planks {
    static constexpr std::string_view name = "planks";
    static constexpr std::string_view human_name = "{n} flat planks";
    static constexpr std::string_view summary =
        "n flat wide boxes (about 20:20:1) across the three axes in the unit cube";
    static constexpr bool has_mesh = false, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        return scattered_boxes(spec, name, [](Draws& draws) {
            Vec3<double> half = 20.0 * (draws.in_cube() + Vec3<double>{0.5, 0.5, 0.5});
            half[static_cast<int>(draws.word() % 3)] /= 20;
            return half;
        });
    }
};

} // namespace

SceneEntry planks_scene() { return scene_entry<Planks>(); }

} // namespace boxwood
