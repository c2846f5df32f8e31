#include "scenes/registry.h"

#include <fmt/format.h>

namespace boxwood {
namespace {

/// A square sheet of m x m squares, two triangles each, their diagonals by turns.
struct Cloth {
    static constexpr std::string_view name = "cloth";
    static constexpr std::string_view human_name = "flat cloth of {n} triangles";
    static constexpr std::string_view summary =
        "a flat square sheet of about n triangles, 3 units wide (seed and overlaps unused)";
    static constexpr bool has_mesh = true, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        std::uint32_t m = 1;
        while (2 * std::uint64_t{m + 1} * (m + 1) <= spec.n)
            ++m;
        Scene scene;
        const double step = 3. / m;
        for (std::uint32_t y = 0; y <= m; ++y)
            for (std::uint32_t x = 0; x <= m; ++x)
                scene.mesh.vertices.push_back(
                    {static_cast<float>(x * step - 1.5), static_cast<float>(y * step - 1.5), 0});
        for (std::uint32_t y = 0; y < m; ++y)
            for (std::uint32_t x = 0; x < m; ++x) {
                const std::uint32_t a = y * (m + 1) + x, b = a + 1, c = a + m + 1, d = c + 1;
                if ((x + y) % 2 == 0)
                    scene.mesh.triangles.insert(scene.mesh.triangles.end(), {{a, b, d}, {a, d, c}});
                else
                    scene.mesh.triangles.insert(scene.mesh.triangles.end(), {{a, b, c}, {b, d, c}});
            }
        scene.params_json = fmt::format(R"({{"squares_per_side":{}}})", m);
        return scene;
    }
};

} // namespace

SceneEntry cloth_scene() { return scene_entry<Cloth>(); }

} // namespace boxwood
