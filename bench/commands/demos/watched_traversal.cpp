#include "bench/commands/demos/watched_traversal.h"

#include "trees/inspect/draw.h"
#include "trees/layout.h"
#include "trees/optimizers/refit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace boxwood::bench {
namespace {

std::string name_of(Pair p, std::span<const std::string> names) {
    return fmt::format("({}, {})", names[p.a], names[p.b]);
}

class Watcher {
  public:
    Watcher(const Tree& tree, std::span<const std::string> names, WatchedTraversal& seen)
        : tree_(tree), names_(names), seen_(seen) {}

    /// The pairs below one node: across its two children, then within each.
    void within(std::size_t node) {
        if (tree_.is_leaf(node))
            return;
        across(Tree::left(node), tree_.right(node));
        within(Tree::left(node));
        within(tree_.right(node));
    }

  private:
    /// The pairs of one item below a and one below b.
    void across(std::size_t a, std::size_t b) {
        const TreeNode &x = tree_.nodes[a], &y = tree_.nodes[b];
        const std::size_t below = std::size_t{x.count} * y.count;
        const auto say = [&](const std::string& what) {
            seen_.lines.push_back(fmt::format("     test {}: {} against {}: {}\n",
                                              seen_.lines.size() + 1, describe(tree_, a, names_),
                                              describe(tree_, b, names_), what));
        };
        if (!overlaps(x.box, y.box)) {
            seen_.pruned += below;
            say(below == 1 ? "apart" : fmt::format("apart -> {} pairs pruned by one test", below));
        } else if (below == 1) {
            const std::uint32_t i = tree_.item(a), j = tree_.item(b);
            seen_.pairs.push_back({std::min(i, j), std::max(i, j)});
            say(fmt::format("overlap -> pair {}", name_of(seen_.pairs.back(), names_)));
        } else {
            say("overlap -> open the larger");
            const double area_x = x.box.half_area(), area_y = y.box.half_area();
            const bool larger = area_x > area_y || (area_x == area_y && x.count >= y.count);
            if (y.count == 1 || (x.count > 1 && larger)) {
                across(Tree::left(a), b);
                across(tree_.right(a), b);
            } else {
                across(a, Tree::left(b));
                across(a, tree_.right(b));
            }
        }
    }

    const Tree& tree_;
    std::span<const std::string> names_;
    WatchedTraversal& seen_;
};

std::vector<Pair> sorted_pairs(const Tree& tree, const AllowedCollisions* allowed) {
    std::vector<Pair> found;
    AppendPairs append(found);
    const auto layout = find_layout("binary").make(tree, serial());
    if (allowed) {
        auto sink = without_allowed(*allowed, append);
        layout->self_pairs(serial(), sink);
    } else {
        layout->self_pairs(serial(), append);
    }
    std::ranges::sort(found);
    return found;
}

} // namespace

std::string WatchedTraversal::text(std::size_t max_lines) const {
    if (lines.size() <= max_lines)
        return fmt::format("{}", fmt::join(lines, ""));
    const std::size_t first = max_lines / 2, last = lines.size() - (max_lines - first);
    return fmt::format(
        "{}     ... {} tests more ...\n{}",
        fmt::join(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(first), ""),
        last - first,
        fmt::join(lines.begin() + static_cast<std::ptrdiff_t>(last), lines.end(), ""));
}

WatchedTraversal watched_traversal(const Tree& tree, std::span<const std::string> names) {
    WatchedTraversal seen;
    if (!tree.empty())
        Watcher(tree, names, seen).within(0);
    std::ranges::sort(seen.pairs);
    if (const std::vector<Pair> found = sorted_pairs(tree, nullptr); found != seen.pairs)
        throw std::logic_error(fmt::format("demo: the traversal shown finds {}, self_pairs {}",
                                           pair_names(seen.pairs, names),
                                           pair_names(found, names)));
    return seen;
}

std::string pair_names(std::span<const Pair> pairs, std::span<const std::string> names) {
    if (pairs.empty())
        return "none";
    std::string text;
    for (const Pair p : pairs)
        text += (text.empty() ? "" : ", ") + name_of(p, names);
    return text;
}

std::vector<Pair> reported_pairs(const Tree& tree, const AllowedCollisions& allowed) {
    return sorted_pairs(tree, &allowed);
}

std::string refit_text(Tree& tree, Boxes boxes, std::span<const std::string> names) {
    std::vector<Box> before;
    for (const TreeNode& node : tree.nodes)
        before.push_back(node.box);
    refit(tree, boxes);
    std::vector<std::string> changed, unchanged;
    for (std::size_t i = tree.nodes.size();
         i-- > 0;) // children before their parents, as refit goes
        (tree.nodes[i].box == before[i] ? unchanged : changed).push_back(describe(tree, i, names));
    return fmt::format("   {} of {} nodes changed, bottom-up: {}.\n   As before: {}.\n",
                       changed.size(), tree.nodes.size(), fmt::join(changed, ", "),
                       unchanged.empty() ? "none" : fmt::format("{}", fmt::join(unchanged, ", ")));
}

} // namespace boxwood::bench
