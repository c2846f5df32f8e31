#include "scenes/registry.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace boxwood {
namespace {

/// The number that begins `text`, behind blanks, and is taken from it. False if there is none.
bool take_number(std::string_view& text, double& number) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{})
        return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
    return true;
}

Aabb<float> box_of(std::string_view row, const std::string& place) {
    double numbers[6];
    for (int i = 0; i < 6; ++i) {
        if (!take_number(row, numbers[i]) || row.empty() != (i == 5) ||
            (i < 5 && !row.starts_with(',')))
            throw std::runtime_error(place + ": a row is min_x,min_y,min_z,max_x,max_y,max_z");
        if (i < 5)
            row.remove_prefix(1);
    }
    constexpr double most = std::numeric_limits<float>::max();
    for (int axis = 0; axis < 3; ++axis) {
        const double low = numbers[axis], high = numbers[axis + 3];
        if (!(std::abs(low) <= most) || !(std::abs(high) <= most))
            throw std::runtime_error(place + ": coordinates must be numbers that a float holds");
        if (low > high)
            throw std::runtime_error(fmt::format("{}: min {} is above max {}", place, low, high));
    }
    const auto corner = [&](int from) {
        return Vec3<float>{static_cast<float>(numbers[from]), static_cast<float>(numbers[from + 1]),
                           static_cast<float>(numbers[from + 2])};
    };
    return {corner(0), corner(3)};
}

/// The user's own boxes, rounded to floats.
struct OwnBoxes {
    static constexpr std::string_view name = "boxes";
    static constexpr std::string_view human_name = "boxes {file}";
    static constexpr std::string_view summary =
        "the boxes of a CSV file, six numbers a line (n, seed and overlaps unused)";
    static constexpr bool has_mesh = false, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        std::ifstream in(spec.file);
        Scene scene;
        std::size_t number = 0;
        for (std::string line; std::getline(in, line);) {
            const std::string place = fmt::format("{}:{}", spec.file.string(), ++number);
            if (const std::size_t first = line.find_first_not_of(" \t\r");
                first != std::string::npos && line[first] != '#')
                scene.boxes.push_back(box_of(line, place));
        }
        if (in.bad() || number == 0)
            throw std::runtime_error(
                fmt::format("{}: cannot read it, or it is empty", spec.file.string()));
        if (scene.boxes.empty())
            throw std::runtime_error(fmt::format("{}: it holds no boxes", spec.file.string()));
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
