#include "scenes/catalogue.h"
#include "scenes/scatter.h"

#include <fmt/format.h>

#include <array>

namespace boxwood {
namespace {

constexpr double width = 0.01; ///< of a triangle, in units of its length

struct Sliver {
    std::array<Vec3<double>, 3> points;
    Vec3<double> half;
};

/// From tip to tip of length 2 in a random direction, its box centred at 0.
Sliver draw_sliver(Draws& draws) {
    const Vec3<double> along = draws.unit_vector(), aside = draws.unit_vector();
    Sliver sliver{{along, -1.0 * along, along + 2 * width * aside}, {}};
    Aabb<double> box;
    for (const Vec3<double>& p : sliver.points)
        box.extend(p);
    for (Vec3<double>& p : sliver.points)
        p = p - 0.5 * (box.min + box.max);
    sliver.half = 0.5 * (box.max - box.min);
    return sliver;
}

/// Triangles that nearly all of their boxes is empty of: hard on every tree of boxes.
struct SliverMesh {
    static constexpr std::string_view name = "sliver_mesh";
    static constexpr std::string_view summary =
        "n unconnected triangles, long and thin (100:1), in random directions in the unit cube";
    static constexpr bool has_mesh = true, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        const double scale =
            scattered_scale(spec, name, [](Draws& draws) { return draw_sliver(draws).half; });
        const Random random(spec.seed, name);
        Scene scene;
        TriangleMesh& mesh = scene.mesh;
        mesh.vertices.reserve(3 * spec.n);
        mesh.triangles.reserve(spec.n);
        for (std::size_t i = 0; i < spec.n; ++i) {
            Draws draws = random.item(i);
            const Sliver sliver = draw_sliver(draws);
            const Vec3<double> centre = draws.in_cube();
            const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.triangles.push_back({first, first + 1, first + 2});
            for (const Vec3<double>& p : sliver.points)
                mesh.vertices.push_back(static_cast<Vec3<float>>(centre + scale * p));
        }
        scene.params_json =
            fmt::format(R"({{"overlaps":{},"scale":{},"width":{}}})", spec.overlaps, scale, width);
        return scene;
    }
};

} // namespace

SceneEntry sliver_mesh_scene() { return scene_entry<SliverMesh>(); }

} // namespace boxwood
