#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

#include <fmt/format.h>

namespace boxwood {
namespace {

constexpr double cloud_side = 0x1p-10, share_outside = 0.01;
constexpr Vec3<double> cloud_low{0.3, 0.6, 0.45};

Placement place(bool is_outside, Draws& draws) {
    Placement placement{.half = draws.in_cube() + Vec3<double>{0.5, 0.5, 0.5}};
    if (!is_outside) {
        placement.low = cloud_low;
        placement.side = {cloud_side, cloud_side, cloud_side};
    }
    return placement;
}

/// A grid over the room sees the cloud as a single cell.
struct CloudInRoom {
    static constexpr std::string_view name = "cloud_in_room";
    static constexpr std::string_view human_name = "{n} boxes, a cloud in a room";
    static constexpr std::string_view summary =
        "n boxes, all but 1 % in a cloud of a thousandth of the width of their room";
    static constexpr bool has_mesh = false, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        constexpr std::uint64_t n_pairs = 4096;
        constexpr double inside = 1 - share_outside;
        const Random sampled(spec.seed, "cloud_in_room.sample");
        std::vector<PlacementPair> sample; // the pairs of the cloud: all others are too far apart
        for (std::uint64_t k = 0; k < n_pairs; ++k) {
            Draws draws = sampled.item(k);
            const Placement a = place(false, draws), b = place(false, draws);
            sample.push_back({a, b, 1.0 / n_pairs});
        }
        const double probability = overlap_probability(spec) / (inside * inside);
        const double scale = scale_of(sample, probability < 0.5 ? probability : 0.5);
        Scene scene;
        scene.boxes = draw_boxes(spec, name, scale, [](std::size_t, Draws& draws) {
            const bool is_outside = draws.uniform() < share_outside;
            return place(is_outside, draws);
        });
        scene.params_json =
            fmt::format(R"({{"overlaps":{},"scale":{},"cloud_side":{},"outside":{}}})",
                        spec.overlaps, scale, cloud_side, share_outside);
        return scene;
    }
};

} // namespace

SceneEntry cloud_in_room_scene() { return scene_entry<CloudInRoom>(); }

} // namespace boxwood
