#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

namespace boxwood {
namespace {

/// A product of factors from 1 to the fourth root of a hundred, or of their reciprocals: a bell by
/// its logarithm, from 1/100 to 100.
double size(Draws& draws) {
    double size = 1;
    for (int i = 0; i < 4; ++i) {
        const double factor = draws.uniform(1, 3.1622776601683795);
        size = draws.word() & 1 ? size * factor : size / factor;
    }
    return size;
}

struct LogNormal {
    static constexpr std::string_view name = "log_normal";
    static constexpr std::string_view human_name = "{n} boxes of log-normal sizes";
    static constexpr std::string_view summary =
        "n boxes of sizes like a log-normal over four decades in the unit cube";
    static constexpr bool has_mesh = false, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        return scattered_boxes(spec, name, [](Draws& draws) {
            const double of_box = size(draws);
            return of_box * (draws.in_cube() + Vec3<double>{0.5, 0.5, 0.5});
        });
    }
};

} // namespace

SceneEntry log_normal_scene() { return scene_entry<LogNormal>(); }

} // namespace boxwood
