#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

namespace boxwood {
namespace {

/// A third each; planks have the volume of bars.
struct Assorted {
    static constexpr std::string_view name = "assorted";
    static constexpr std::string_view human_name = "{n} cubes, bars and planks";
    static constexpr std::string_view summary =
        "n cubes, bars 15.2 x 0.4 x 0.4 and planks along the axes (Broadmark; overlaps unused)";
    static constexpr bool has_mesh = false, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        return boxes_at_density(spec, name, .1, [](Draws& draws) {
            const std::uint32_t kind = draws.word() % 3;
            const int axis = static_cast<int>(draws.word() % 3);
            Vec3<double> sides{1, 1, 1};
            if (kind == 0)
                return sides;
            const double across = kind == 1 ? .4 : 3.9;
            sides = {across, across, across};
            sides[axis] = kind == 1 ? 15.2 : .16;
            return sides;
        });
    }
};

} // namespace

SceneEntry assorted_scene() { return scene_entry<Assorted>(); }

} // namespace boxwood
