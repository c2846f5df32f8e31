#include "scenes/catalogue.h"
#include "scenes/scatter.h"

#include <fmt/format.h>

namespace boxwood {
namespace {

/// Three corners uniform in the cube of half size 1, moved so that their box is centred at 0.
struct Corners {
    std::array<Vec3<double>, 3> points;
    Vec3<double> half;
};

Corners draw_corners(Draws& draws) {
    Corners corners{{draws.in_cube(), draws.in_cube(), draws.in_cube()}, {}};
    Aabb<double> box;
    for (const Vec3<double>& p : corners.points)
        box.extend(p);
    for (Vec3<double>& p : corners.points)
        p = p - 0.5 * (box.min + box.max);
    corners.half = 0.5 * (box.max - box.min);
    return corners;
}

/// Unconnected triangles, whose boxes overlap as often as spec.overlaps asks for.
struct TriangleSoup {
    static constexpr std::string_view name = "triangle_soup";
    static constexpr std::string_view summary =
        "n unconnected small triangles of random shape in the unit cube";
    static constexpr bool has_mesh = true, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        const double scale =
            scattered_scale(spec, name, [](Draws& draws) { return draw_corners(draws).half; });
        const Random random(spec.seed, name);
        Scene scene;
        TriangleMesh& mesh = scene.mesh;
        mesh.vertices.reserve(3 * spec.n);
        mesh.triangles.reserve(spec.n);
        for (std::size_t i = 0; i < spec.n; ++i) {
            Draws draws = random.item(i);
            const Corners corners = draw_corners(draws);
            const Vec3<double> centre = draws.in_cube();
            const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.triangles.push_back({first, first + 1, first + 2});
            for (const Vec3<double>& p : corners.points)
                mesh.vertices.push_back(static_cast<Vec3<float>>(centre + scale * p));
        }
        scene.params_json = fmt::format(R"({{"overlaps":{},"scale":{}}})", spec.overlaps, scale);
        return scene;
    }
};

} // namespace

SceneEntry triangle_soup_scene() { return scene_entry<TriangleSoup>(); }

} // namespace boxwood
