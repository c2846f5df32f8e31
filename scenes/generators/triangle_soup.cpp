#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

namespace boxwood {
namespace {

/// Unconnected triangles of any shape: three corners uniform in a cube.
struct TriangleSoup {
    static constexpr std::string_view name = "triangle_soup";
    static constexpr std::string_view human_name = "triangle soup, {n} triangles";
    static constexpr std::string_view summary =
        "n unconnected small triangles of random shape in the unit cube";
    static constexpr bool has_mesh = true, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        return scattered_triangles(spec, name, [](Draws& draws) {
            return Corners{draws.in_cube(), draws.in_cube(), draws.in_cube()};
        });
    }
};

} // namespace

SceneEntry triangle_soup_scene() { return scene_entry<TriangleSoup>(); }

} // namespace boxwood
