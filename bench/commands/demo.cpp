#include "bench/commands/demo.h"

#include "bench/commands/command.h"
#include "scenes/robots/four_link.h"
#include "scenes/scene.h"
#include "trees/builder.h"
#include "trees/inspect/draw.h"
#include "trees/layout.h"
#include "trees/optimizers/refit.h"
#include "trees/queries/allowed_collisions.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <stdexcept>

namespace boxwood::bench {
namespace {

const std::vector<std::string> link_names(four_link_names.begin(), four_link_names.end());
using FourBoxes = std::array<Box, 4>;

std::string name_of(Pair p) { return fmt::format("({}, {})", link_names[p.a], link_names[p.b]); }

std::string pair_names(const std::vector<Pair>& pairs) {
    if (pairs.empty())
        return "none";
    std::string text;
    for (const Pair p : pairs)
        text += (text.empty() ? "" : ", ") + name_of(p);
    return text;
}

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

/// The traversal of self_pairs over a small tree, written to be watched: a line per box test.
struct Traversal {
    const Tree& tree;
    std::string text;
    std::size_t tests = 0, pruned = 0;
    std::vector<Pair> pairs;

    explicit Traversal(const Tree& tree_) : tree(tree_) {
        if (!tree.empty())
            within(0);
        std::sort(pairs.begin(), pairs.end());
    }

    /// The pairs below one node: across its two children, then within each.
    void within(std::size_t node) {
        if (tree.is_leaf(node))
            return;
        across(Tree::left(node), tree.right(node));
        within(Tree::left(node));
        within(tree.right(node));
    }

    /// The pairs of one item below a and one below b.
    void across(std::size_t a, std::size_t b) {
        const TreeNode &x = tree.nodes[a], &y = tree.nodes[b];
        const std::size_t below = std::size_t{x.count} * y.count;
        text += fmt::format("     test {}: {} against {}: ", ++tests, describe(tree, a, link_names),
                            describe(tree, b, link_names));
        if (!overlaps(x.box, y.box)) {
            pruned += below;
            text += below == 1 ? "apart\n"
                               : fmt::format("apart -> {} pairs pruned by one test\n", below);
        } else if (below == 1) {
            const std::uint32_t i = tree.item(a), j = tree.item(b);
            pairs.push_back({std::min(i, j), std::max(i, j)});
            text += fmt::format("overlap -> pair {}\n", name_of(pairs.back()));
        } else {
            text += "overlap -> open the larger\n";
            const double area_x = x.box.half_area(), area_y = y.box.half_area();
            const bool larger = area_x > area_y || (area_x == area_y && x.count >= y.count);
            if (y.count == 1 || (x.count > 1 && larger)) {
                across(Tree::left(a), b);
                across(tree.right(a), b);
            } else {
                across(a, Tree::left(b));
                across(a, tree.right(b));
            }
        }
    }
};

/// The traversal, after the library has confirmed what it found.
Traversal confirmed_traversal(const Tree& tree) {
    Traversal traversal(tree);
    std::vector<Pair> found;
    AppendPairs sink(found);
    find_layout("binary").make(tree, serial())->self_pairs(serial(), sink);
    std::sort(found.begin(), found.end());
    if (found != traversal.pairs)
        throw std::logic_error("demo four-link: the traversal shown finds " +
                               pair_names(traversal.pairs) + ", self_pairs finds " +
                               pair_names(found));
    return traversal;
}

/// The pairs of the tree that are worth reporting.
std::vector<Pair> reported_pairs(const Tree& tree, const AllowedCollisions& allowed) {
    std::vector<Pair> found;
    AppendPairs append(found);
    auto sink = without_allowed(allowed, append);
    find_layout("binary").make(tree, serial())->self_pairs(serial(), sink);
    std::sort(found.begin(), found.end());
    return found;
}

/// Refits the tree to new boxes and says which nodes changed.
std::string refit_text(Tree& tree, const FourBoxes& boxes) {
    std::vector<Box> before;
    for (const TreeNode& node : tree.nodes)
        before.push_back(node.box);
    refit(tree, boxes);
    std::vector<std::string> changed, unchanged;
    for (std::size_t i = tree.nodes.size();
         i-- > 0;) // children before their parents, as refit goes
        (tree.nodes[i].box == before[i] ? unchanged : changed)
            .push_back(describe(tree, i, link_names));
    return fmt::format("   {} of {} nodes changed, bottom-up: {}.\n   As before: {}.\n",
                       changed.size(), tree.nodes.size(), fmt::join(changed, ", "),
                       unchanged.empty() ? "none" : fmt::format("{}", fmt::join(unchanged, ", ")));
}

std::string pair_step(const Tree& tree, const AllowedCollisions& allowed) {
    const Traversal traversal = confirmed_traversal(tree);
    return fmt::format("{}   Overlapping: {}.\n   Not allowed, so reported: {}.\n", traversal.text,
                       pair_names(traversal.pairs), pair_names(reported_pairs(tree, allowed)));
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

    const Traversal traversal = confirmed_traversal(tree);
    text += fmt::format(
        "4. The traversal\n"
        "   At each node, test its left side against its right side. If two boxes are apart, so\n"
        "   is everything inside them: all pairs across are pruned by that one test.\n\n"
        "{}\n   Pairs found: {}.\n   {} box tests instead of {}; {} of {} pairs were never looked "
        "at.\n{}\n",
        traversal.text, pair_names(traversal.pairs), traversal.tests, all_pairs,
        all_pairs - std::min(all_pairs, traversal.tests), all_pairs, large_case());

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
        allowed.size(), pair_names(filtered), reported.size());

    const FourBoxes bent = four_link_boxes(four_link_bent);
    text += fmt::format(
        "6. Joints turn, and the tree is refitted\n"
        "   The first two joints turn by {:.0f} and {:.0f} degrees. Forward kinematics moves the "
        "links\n"
        "   and gives each a new box:\n\n{}\n{}\n"
        "   The tree keeps its shape. Refitting gives each leaf its new box, then each parent the\n"
        "   box of its two children: one pass, much cheaper than building again.\n",
        degrees(four_link_bent[0]), degrees(four_link_bent[1]), box_lines(bent), sketch(bent));
    text += refit_text(tree, bent) + "\n";
    text += pair_step(tree, allowed) + "\n";

    const FourBoxes folded = four_link_boxes(four_link_folded);
    text += fmt::format("7. The last joint alone turns by {:.0f} degrees\n\n{}\n{}\n",
                        degrees(four_link_folded[2] - four_link_bent[2]), box_lines(folded),
                        sketch(folded));
    text += refit_text(tree, folded) + "\n";
    text += draw(tree, link_names) + "\n";

    text += "8. Pairs again\n" + pair_step(tree, allowed);
    const std::size_t tests = confirmed_traversal(tree).tests;
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

namespace {

/// A line per demo.
std::string demos_text(const CLI::App& demo) {
    std::string text = "The demos:\n";
    for (const CLI::App* each : demo.get_subcommands([](const CLI::App*) { return true; }))
        text +=
            fmt::format("  boxwood demo {:<12} {}\n", each->get_name(), each->get_description());
    return text;
}

} // namespace

void add_demo(CLI::App& app, int&) {
    CLI::App* demo = app.add_subcommand("demo", "see how it works, step by step");
    demo->require_subcommand(0, 1);
    demo->footer("Example: boxwood demo four-link");
    demo->callback([demo] {
        if (demo->get_subcommands().empty())
            std::cout << demos_text(*demo);
    });
    CLI::App* four_link = demo->add_subcommand(
        "four-link",
        "a robot of four links: the tree, its traversal, allowed pairs, a joint that turns");
    four_link->footer("Example: boxwood demo four-link");
    four_link->callback([] { std::cout << four_link_demo(); });
}

} // namespace boxwood::bench
