#include "scenes/registry.h"
#include "scenes/text/rows.h"

namespace boxwood {
namespace {

/// The user's own boxes, rounded to floats.
struct OwnBoxes {
    static constexpr std::string_view name = "boxes";
    static constexpr std::string_view human_name = "boxes {file}";
    static constexpr std::string_view summary =
        "the boxes of a CSV file, six numbers a line (n, seed and overlaps unused)";
    static constexpr bool has_mesh = false, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        Scene scene;
        read_rows(spec.file, {"min_x,min_y,min_z,max_x,max_y,max_z", 6, 6},
                  [&](std::span<const double> row, const std::string& place) {
                      scene.boxes.push_back(box_of(row.first<6>(), place));
                  });
        scene.params_json = "{}";
        return scene;
    }
};

} // namespace

SceneEntry boxes_scene() {
    SceneEntry entry = scene_entry<OwnBoxes>();
    entry.reads_file = true;
    return entry;
}

} // namespace boxwood
