#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

namespace boxwood {
namespace {

/// Boxes of much the same size, everywhere alike: each side within a factor of three.
struct Uniform {
    static constexpr std::string_view name = "uniform";
    static constexpr std::string_view human_name = "{n} uniform boxes";
    static constexpr std::string_view summary =
        "n boxes of sides 1:1 to 1:3 uniform in the unit cube";
    static constexpr bool has_mesh = false, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        return scattered_boxes(spec, name, [](Draws& draws) {
            return draws.in_cube() + Vec3<double>{0.5, 0.5, 0.5};
        });
    }
};

} // namespace

SceneEntry uniform_scene() { return scene_entry<Uniform>(); }

} // namespace boxwood
