#include "scenes/generators/sheet.h"
#include "scenes/registry.h"

#include <fmt/format.h>

#include <cmath>

namespace boxwood {
namespace {

/// Period 1, heights -1 to 1: parabolas, which every machine computes alike.
double wave(double x) {
    const double s = 2 * (x - std::floor(x)) - 1;
    return 4 * s * (1 - std::abs(s));
}

/// Curved in both directions, so that one above it is not equally far from it everywhere.
struct WavySheet {
    static constexpr std::string_view name = "wavy_sheet";
    static constexpr std::string_view human_name = "wavy sheet of {n} triangles";
    static constexpr std::string_view summary =
        "a square sheet of about n triangles, 3 units wide, three waves 0.1 high along each side "
        "(seed and overlaps unused)";
    static constexpr bool has_mesh = true, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        Scene scene;
        const std::uint32_t m = squares_per_side(spec.n);
        scene.mesh = sheet(m, [](double x, double y) { return .025 * (wave(x) + wave(y)); });
        scene.params_json = fmt::format(R"({{"squares_per_side":{}}})", m);
        return scene;
    }
};

} // namespace

SceneEntry wavy_sheet_scene() { return scene_entry<WavySheet>(); }

} // namespace boxwood
