#include "scenes/registry.h"

#include <fmt/format.h>

#include <numeric>

namespace boxwood {
namespace {

/// Voxels, bricks, cells of a mesh: every box shares faces, edges and corners with up to 26 others,
/// in coordinates that floats hold exactly. The items come in a scrambled order.
struct Lattice {
    static constexpr std::string_view name = "lattice";
    static constexpr std::string_view human_name = "{n} cubes that touch";
    static constexpr std::string_view summary =
        "n unit cubes of a lattice, each touching up to 26 others (overlaps unused)";
    static constexpr bool has_mesh = false, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        std::uint64_t side = 1;
        while (side * side * side < spec.n)
            ++side;
        // Steps of a number without a common factor come to each cell once.
        std::uint64_t step = 2 * (spec.seed % 0x10000) + 0x9e3779b1u;
        while (std::gcd(step, std::uint64_t{spec.n}) != 1)
            ++step;
        Scene scene;
        scene.boxes.reserve(spec.n);
        for (std::uint64_t i = 0; i < spec.n; ++i) {
            const std::uint64_t cell = i * step % spec.n;
            const Vec3<float> low{static_cast<float>(cell % side),
                                  static_cast<float>(cell / side % side),
                                  static_cast<float>(cell / side / side)};
            scene.boxes.push_back({low, low + Vec3<float>{1, 1, 1}});
        }
        scene.params_json = fmt::format(R"({{"side":{}}})", side);
        return scene;
    }
};

} // namespace

SceneEntry lattice_scene() { return scene_entry<Lattice>(); }

} // namespace boxwood
