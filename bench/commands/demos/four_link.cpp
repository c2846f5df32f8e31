#include "scenes/robots/four_link.h"
#include "bench/commands/demos/demo.h"
#include "bench/commands/demos/watched_traversal.h"
#include "scenes/scene.h"
#include "trees/builder.h"
#include "trees/inspect/draw.h"
#include "trees/layout.h"
#include "trees/queries/allowed_collisions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace boxwood::bench {
namespace {

const std::vector<std::string> link_names(four_link_names.begin(), four_link_names.end());
using FourBoxes = std::array<Box, 4>;

/// The boxes seen from above: a letter per link, # where two or more overlap.
std::string sketch(const FourBoxes& boxes) {
    constexpr float column = 1 / 24.f, row = 1 / 12.f; // a character is about twice as high as wide
    Box all;
    for (const Box& box : boxes)
        all.extend(box);
    const auto columns = static_cast<int>(std::lround((all.max.x - all.min.x) / column));
    const auto rows = static_cast<int>(std::lround((all.max.y - all.min.y) / row));
    std::string text;
    for (int r = 0; r < rows; ++r) {
        std::string line;
        for (int c = 0; c < columns; ++c) {
            const Vec3<float> p{all.min.x + (static_cast<float>(c) + .5f) * column,
                                all.max.y - (static_cast<float>(r) + .5f) * row, 0};
            char mark = ' ';
            for (std::size_t i = 0; i < boxes.size(); ++i)
                if (boxes[i].contains(p))
                    mark = mark == ' ' ? link_names[i][0] : '#';
            line += mark;
        }
        text += "     " + line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

std::string box_lines(const FourBoxes& boxes) {
    std::string text;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        text +=
            fmt::format("     {:<9} x [{:5.2f}, {:5.2f}]  y [{:5.2f}, {:5.2f}]\n", link_names[i],
                        boxes[i].min.x, boxes[i].max.x, boxes[i].min.y, boxes[i].max.y);
    return text;
}

std::string pair_step(const Tree& tree, const AllowedCollisions& allowed) {
    const WatchedTraversal traversal = watched_traversal(tree, link_names);
    return fmt::format("{}   Overlapping: {}.\n   Not allowed, so reported: {}.\n",
                       traversal.text(), pair_names(traversal.pairs, link_names),
                       pair_names(reported_pairs(tree, allowed), link_names));
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// How the saving grows: the same traversal over many boxes.
std::string large_case() {
    const std::size_t n = 10'000;
    SceneSpec spec;
    spec.generator = "uniform";
    spec.n = n;
    spec.overlaps = 1;
    const Scene scene = make_scene(spec);
    CountPairs sink;
    const Tree tree = find_builder("median").make({})(scene.boxes, serial());
    const Work work = find_layout("binary").make(tree, serial())->self_pairs_counted(sink);
    return fmt::format(
        "   With many boxes the saving grows: for {} random boxes with {} overlapping\n"
        "   pairs the same traversal makes {} box tests, brute force {}: {:.0f} times more.\n",
        n, sink.count(), work.box_tests, n * (n - 1) / 2,
        static_cast<double>(n * (n - 1) / 2) / static_cast<double>(work.box_tests));
}

} // namespace

std::string four_link_demo() {
    const FourBoxes straight = four_link_boxes(four_link_straight);
    const std::size_t n = straight.size(), all_pairs = n * (n - 1) / 2;

    std::string text = fmt::format(
        "The four-link robot: which links may collide?\n\n"
        "1. The links and their boxes\n"
        "   An arm of four links lies along x. Around each link we put an axis-aligned box: links\n"
        "   can only touch where their boxes overlap, and six comparisons tell whether two boxes "
        "do.\n\n"
        "{}\n   Seen from above, a letter per link, # where boxes overlap:\n\n{}\n",
        box_lines(straight), sketch(straight));

    text += fmt::format(
        "2. Without a tree\n"
        "   Brute force tests each link against each other: {} x {} / 2 = {} box tests.\n"
        "   Twice the links, four times the tests.\n\n",
        n, n - 1, all_pairs);

    Tree tree = find_builder("median").make({})(straight, serial());
    text +=
        "3. The tree, built by median split\n"
        "   Sort the links by their centres along the axis of largest spread (x), cut the row in\n"
        "   the middle, and do the same with each half. A node's box holds all boxes below it.\n\n";
    text += draw(tree, link_names) + "\n";

    const WatchedTraversal traversal = watched_traversal(tree, link_names);
    text += fmt::format(
        "4. The traversal\n"
        "   At each node, test its left side against its right side. If two boxes are apart, so\n"
        "   is everything inside them: all pairs across are pruned by that one test.\n\n"
        "{}\n   Pairs found: {}.\n   {} box tests instead of {}; {} of {} pairs were never looked "
        "at.\n{}\n",
        traversal.text(), pair_names(traversal.pairs, link_names), traversal.lines.size(),
        all_pairs, all_pairs - std::min(all_pairs, traversal.lines.size()), all_pairs,
        large_case());

    const AllowedCollisions allowed = allow_neighbours(n);
    std::vector<Pair> filtered;
    for (const Pair p : traversal.pairs)
        if (allowed.allows(p.a, p.b))
            filtered.push_back(p);
    const auto reported = reported_pairs(tree, allowed);
    text += fmt::format(
        "5. Adjacent links are allowed to overlap\n"
        "   Links that share a joint may overlap there; that is no collision. An allowed\n"
        "   collision matrix marks the {} adjacent pairs, and a filter drops them from what is\n"
        "   found. Dropped: {}. Left to report: {}.\n\n",
        allowed.size(), pair_names(filtered, link_names), reported.size());

    const FourBoxes bent = four_link_boxes(four_link_bent);
    text += fmt::format(
        "6. Joints turn, and the tree is refitted\n"
        "   The first two joints turn by {:.0f} and {:.0f} degrees. Forward kinematics moves the "
        "links\n"
        "   and gives each a new box:\n\n{}\n{}\n"
        "   The tree keeps its shape. Refitting gives each leaf its new box, then each parent the\n"
        "   box of its two children: one pass, much cheaper than building again.\n",
        degrees(four_link_bent[0]), degrees(four_link_bent[1]), box_lines(bent), sketch(bent));
    text += refit_text(tree, bent, link_names) + "\n";
    text += pair_step(tree, allowed) + "\n";

    const FourBoxes folded = four_link_boxes(four_link_folded);
    text += fmt::format("7. The last joint alone turns by {:.0f} degrees\n\n{}\n{}\n",
                        degrees(four_link_folded[2] - four_link_bent[2]), box_lines(folded),
                        sketch(folded));
    text += refit_text(tree, folded, link_names) + "\n";
    text += draw(tree, link_names) + "\n";

    text += "8. Pairs again\n" + pair_step(tree, allowed);
    const std::size_t tests = watched_traversal(tree, link_names).lines.size();
    for (const Pair p : reported_pairs(tree, allowed))
        text += fmt::format(
            "   A real collision to look into: {} meets {}. They are in different subtrees, and "
            "the\n"
            "   traversal finds them, since it tests the two sides of every node against each "
            "other.\n",
            link_names[p.b], link_names[p.a]);
    text += fmt::format("   It took {} box tests, {} than the {} of brute force: nodes that "
                        "overlap must be opened.\n"
                        "   A tree pays where boxes are many and most pairs are far apart.\n",
                        tests, tests > all_pairs ? "more" : "no more", all_pairs);
    return text;
}

} // namespace boxwood::bench
