#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

namespace boxwood {
namespace {

/// Bars about 20 times as long as thick, one third along each axis.
struct Bars {
    static constexpr std::string_view name = "bars";
    static constexpr std::string_view human_name = "{n} long bars";
    static constexpr std::string_view summary =
        "n long thin boxes (about 20:1:1) along the three axes in the unit cube";
    static constexpr bool has_mesh = false, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        return scattered_boxes(spec, name, [](Draws& draws) {
            Vec3<double> half = draws.in_cube() + Vec3<double>{0.5, 0.5, 0.5};
            half[static_cast<int>(draws.word() % 3)] *= 20;
            return half;
        });
    }
};

} // namespace

SceneEntry bars_scene() { return scene_entry<Bars>(); }

} // namespace boxwood
