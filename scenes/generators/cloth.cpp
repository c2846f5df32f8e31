#include "scenes/generators/sheet.h"
#include "scenes/registry.h"

#include <fmt/format.h>

namespace boxwood {
namespace {

struct Cloth {
    static constexpr std::string_view name = "cloth";
    static constexpr std::string_view human_name = "flat cloth of {n} triangles";
    static constexpr std::string_view summary =
        "a flat square sheet of about n triangles, 3 units wide (seed and overlaps unused)";
    static constexpr bool has_mesh = true, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        Scene scene;
        const std::uint32_t m = squares_per_side(spec.n);
        scene.mesh = sheet(m, [](double, double) { return 0.; });
        scene.params_json = fmt::format(R"({{"squares_per_side":{}}})", m);
        return scene;
    }
};

} // namespace

SceneEntry cloth_scene() { return scene_entry<Cloth>(); }

} // namespace boxwood
