#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

namespace boxwood {
namespace {

/// The box of a capsule of radius 1 and half length h along the unit vector d has the half size
/// h |d| + 1 per axis: mostly empty, as the boxes of cables, pipes and hair are.
struct Needles {
    static constexpr std::string_view name = "needles";
    static constexpr std::string_view human_name = "{n} needles";
    static constexpr std::string_view summary =
        "n boxes of thin bodies (about 20:1) in random directions in the unit cube";
    static constexpr bool has_mesh = false, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        return scattered_boxes(spec, name, [](Draws& draws) {
            const Vec3<double> d = draws.unit_vector();
            const double h = draws.uniform(10, 30);
            return Vec3<double>{h * std::abs(d.x) + 1, h * std::abs(d.y) + 1,
                                h * std::abs(d.z) + 1};
        });
    }
};

} // namespace

SceneEntry needles_scene() { return scene_entry<Needles>(); }

} // namespace boxwood
