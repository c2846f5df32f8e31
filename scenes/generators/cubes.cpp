#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

namespace boxwood {
namespace {

struct Cubes {
    static constexpr std::string_view name = "cubes";
    static constexpr std::string_view human_name = "{n} unit cubes";
    static constexpr std::string_view summary =
        "n unit cubes in a cube ten times their volume (Broadmark; overlaps unused)";
    static constexpr bool has_mesh = false, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        return boxes_at_density(spec, name, .1, [](Draws&) { return Vec3<double>{1, 1, 1}; });
    }
};

} // namespace

SceneEntry cubes_scene() { return scene_entry<Cubes>(); }

} // namespace boxwood
