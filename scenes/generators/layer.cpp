#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

#include <fmt/format.h>

namespace boxwood {
namespace {

constexpr double thickness = 0.001;

Placement place(Draws& draws) {
    return {.side = {1, 1, thickness}, .half = draws.in_cube() + Vec3<double>{0.5, 0.5, 0.5}};
}

/// What lies on a floor or a map: two axes tell the boxes apart, the third hardly.
struct Layer {
    static constexpr std::string_view name = "layer";
    static constexpr std::string_view human_name = "{n} boxes in a layer";
    static constexpr std::string_view summary =
        "n boxes of sides 1:1 to 1:3 in a layer a thousandth as thick as it is wide";
    static constexpr bool has_mesh = false, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        constexpr std::uint64_t n_pairs = 8192;
        const Random sampled(spec.seed, "layer.sample");
        std::vector<PlacementPair> sample;
        for (std::uint64_t k = 0; k < n_pairs; ++k) {
            Draws draws = sampled.item(k);
            const Placement a = place(draws), b = place(draws);
            sample.push_back({a, b, 1.0 / n_pairs});
        }
        const double scale = scale_of(sample, overlap_probability(spec));
        Scene scene;
        scene.boxes =
            draw_boxes(spec, name, scale, [&](std::size_t, Draws& draws) { return place(draws); });
        scene.params_json = fmt::format(R"({{"overlaps":{},"scale":{},"thickness":{}}})",
                                        spec.overlaps, scale, thickness);
        return scene;
    }
};

} // namespace

SceneEntry layer_scene() { return scene_entry<Layer>(); }

} // namespace boxwood
