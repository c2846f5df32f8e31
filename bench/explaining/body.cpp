#include "bench/explaining/drawing.h"
#include "bench/explaining/explain.h"

#include "bench/io/scene_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace boxwood::bench {
namespace {

double gap(const Box& a, const Box& b) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double apart =
            std::max({0., static_cast<double>(b.min[axis]) - static_cast<double>(a.max[axis]),
                      static_cast<double>(a.min[axis]) - static_cast<double>(b.max[axis])});
        sum += apart * apart;
    }
    return std::sqrt(sum);
}

std::vector<std::string_view> effects_of(const MovingScene& scene, std::uint32_t body) {
    std::vector<std::string_view> names;
    for (const MovingScene::Laid& laid : scene.effects())
        if (std::ranges::binary_search(laid.chosen, body))
            names.push_back(laid.entry->name);
    return names;
}

/// Whether what is ignored of a whole group, or of neighbours alone, has this pair.
bool is_left_out(const MovingScene& scene, std::uint32_t a, std::uint32_t b, bool of_group) {
    return std::ranges::any_of(scene.ignored(), [&](const IgnoredPairs& ignored) {
        return ignored.all == of_group && ignored.has(std::min(a, b), std::max(a, b));
    });
}

} // namespace

Explanation explain_body(const MovingScene& scene, std::uint32_t body) {
    const Bodies& bodies = scene.bodies();
    if (body >= bodies.size())
        throw std::invalid_argument(
            fmt::format("there is no body {}; they are 0 to {}", body, bodies.size() - 1));
    const Box own = pair_box(scene, body);
    Explanation answer;
    const std::vector<std::string_view> effects = effects_of(scene, body);
    answer.text =
        fmt::format("Body {} of {}, frame {}: {}.\n", body, scene.file().name, scene.frame(),
                    effects.empty() ? "no effect is laid on it, so that it rests"
                                    : fmt::format("moved by {}", fmt::join(effects, ", ")));
    if (own.is_empty()) {
        answer.text += "It is not present, and so in no pair.\n";
        return answer;
    }
    answer.text += fmt::format("  its box {}\n", box_text(own));
    for (const Margin& margin : scene.margins())
        if (margin.first <= body && body < margin.last)
            answer.text += fmt::format("  widened by its group's margin of {:g}\n", margin.margin);
    Drawing drawing(fmt::format("body {} of {}, frame {}", body, scene.file().name, scene.frame()));
    std::vector<std::uint32_t> pairs, expected;
    std::uint32_t nearest = body;
    double nearest_gap = std::numeric_limits<double>::infinity();
    for (std::uint32_t other = 0; other < bodies.size(); ++other) {
        const Box box = pair_box(scene, other);
        if (other == body || box.is_empty())
            continue;
        if (!overlaps(own, box)) {
            if (const double d = gap(own, box); d < nearest_gap) {
                nearest_gap = d;
                nearest = other;
            }
            continue;
        }
        const bool is_expected = scene.is_ignored(std::min(body, other), std::max(body, other));
        (is_expected ? expected : pairs).push_back(other);
        drawing.box(box, is_expected ? "node" : "item-b", fmt::format("{}", other));
    }
    answer.text += pairs.empty() ? "It is in no pair.\n"
                                 : fmt::format("It is a pair with {} {}: {}: their boxes share a "
                                               "point, which is what `pairs` asks.\n",
                                               pairs.size(), pairs.size() == 1 ? "body" : "bodies",
                                               fmt::join(pairs, ", "));
    for (const auto& [word, is_all] :
         {std::pair("neighbours_ignored", false), {"group_ignored", true}}) {
        std::vector<std::uint32_t> left_out;
        for (const std::uint32_t other : expected)
            if (is_left_out(scene, body, other, is_all))
                left_out.push_back(other);
        if (!left_out.empty())
            answer.text +=
                fmt::format("Their boxes share a point, too, and the scene file leaves them "
                            "out by {}: {}.\n",
                            word, fmt::join(left_out, ", "));
    }
    if (nearest != body) {
        answer.text +=
            fmt::format("The nearest other: body {}, {:.6g} away.\n", nearest, nearest_gap);
        drawing.box(pair_box(scene, nearest), "second", fmt::format("{}", nearest));
    }
    if (!pairs.empty()) {
        const BoxedBodies boxed_bodies = boxed(bodies);
        const auto at = [&](std::uint32_t of) {
            return static_cast<std::uint32_t>(std::ranges::find(boxed_bodies.body, of) -
                                              boxed_bodies.body.begin());
        };
        const std::uint32_t other = pairs.front();
        answer.text += fmt::format(
            "\nThe way to body {} (items are the present bodies):\n{}", other,
            explain_pair(boxed_bodies.tree, boxed_bodies.boxes, at(body), at(other)).text);
    }
    drawing.box(own, "item-a", fmt::format("{}", body));
    answer.svg = drawing.svg();
    return answer;
}

} // namespace boxwood::bench
