#include "bench/grading/grade.h"

#include "kernels/ray_box/slabs.h"
#include "scenes/sampling/random.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace boxwood::bench {
namespace {

constexpr std::size_t n_queries = 2000; ///< of each kind

/// Surface of a box.
double area(const Box& box) { return 2 * box.half_area(); }

/// The part of the faces of `item` that lies in `node`.
double surface_within(const Box& item, const Box& node) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        double face = 1;
        for (int other = 0; other < 3; ++other)
            if (other != axis)
                face *= std::max(
                    0., static_cast<double>(std::min(item.max[other], node.max[other])) -
                            static_cast<double>(std::max(item.min[other], node.min[other])));
        for (const float at : {item.min[axis], item.max[axis]})
            if (node.min[axis] <= at && at <= node.max[axis])
                sum += face;
    }
    return sum;
}

/// Calls meets(box) for the root and for what is below each node that is met.
template <class Meets> Grade::Counted traverse(const NodeTable& tree, const Meets& meets) {
    Grade::Counted counted;
    std::vector<std::uint32_t> waiting;
    ++counted.tests;
    if (meets(tree.nodes()[0].box))
        waiting.push_back(0);
    while (!waiting.empty()) {
        const NodeTable::Node& node = tree.nodes()[waiting.back()];
        waiting.pop_back();
        ++counted.visits;
        for (const std::uint32_t child : tree.children(node)) {
            ++counted.tests;
            if (meets(tree.nodes()[child].box))
                waiting.push_back(child);
        }
        counted.tests += node.n_items;
    }
    return counted;
}

class Grader {
  public:
    Grader(const NodeTable& tree, std::uint64_t seed) : tree_(tree), random_(seed, "grade") {
        for (const Box& box : tree.boxes())
            all_.extend(box);
        ancestors_of_items();
    }

    Grade grade() {
        shape();
        end_point_overlap();
        count();
        return grade_;
    }

  private:
    /// Parents come before their children.
    void ancestors_of_items() {
        parent_.assign(tree_.nodes().size(), no_node);
        node_of_.assign(tree_.boxes().size(), 0);
        for (std::uint32_t i = 0; i < tree_.nodes().size(); ++i) {
            for (const std::uint32_t child : tree_.children(tree_.nodes()[i]))
                parent_[child] = i;
            for (const std::uint32_t item : tree_.items(tree_.nodes()[i]))
                node_of_[item] = i;
        }
    }

    void shape() {
        const double whole = area(all_);
        std::vector<std::uint64_t> depth(tree_.nodes().size());
        std::size_t leaves = 0;
        for (std::size_t i = 0; i < tree_.nodes().size(); ++i) {
            const NodeTable::Node& node = tree_.nodes()[i];
            depth[i] = parent_[i] == no_node ? 0 : depth[parent_[i]] + 1;
            grade_.depth = std::max(grade_.depth, depth[i]);
            const double share = whole > 0 ? area(node.box) / whole : 1;
            grade_.sah_visits += node.n_children > 0 ? share : 0;
            grade_.sah_tests += node.n_items * share;
            leaves += node.n_items > 0;
        }
        grade_.n_nodes = tree_.nodes().size();
        grade_.items_per_leaf =
            leaves ? static_cast<double>(tree_.boxes().size()) / static_cast<double>(leaves) : 0;
    }

    std::vector<std::uint32_t> some_items() const {
        const std::size_t n = tree_.boxes().size(), step = epo_step(n);
        std::vector<std::uint32_t> some;
        for (std::size_t i = 0; i < n; i += step)
            some.push_back(static_cast<std::uint32_t>(i));
        return some;
    }

    void end_point_overlap() {
        double surface = 0, outside = 0;
        std::vector<bool> is_above(tree_.nodes().size());
        for (const std::uint32_t item : some_items()) {
            const Box& box = tree_.boxes()[item];
            surface += area(box);
            std::vector<std::uint32_t> above;
            for (std::uint32_t node = node_of_[item]; node != no_node; node = parent_[node]) {
                is_above[node] = true;
                above.push_back(node);
            }
            std::vector<std::uint32_t> waiting{0};
            while (!waiting.empty()) {
                const std::uint32_t i = waiting.back();
                waiting.pop_back();
                const NodeTable::Node& node = tree_.nodes()[i];
                if (!overlaps(node.box, box))
                    continue;
                if (!is_above[i])
                    outside += surface_within(box, node.box) * std::max(1u, node.n_items);
                for (const std::uint32_t child : tree_.children(node))
                    waiting.push_back(child);
            }
            for (const std::uint32_t node : above)
                is_above[node] = false;
        }
        grade_.epo = surface > 0 ? outside / surface : 0;
    }

    void count() {
        const auto mean = [](Grade::Counted& of, std::size_t n) {
            of.visits /= static_cast<double>(std::max<std::size_t>(n, 1));
            of.tests /= static_cast<double>(std::max<std::size_t>(n, 1));
        };
        const auto add = [](Grade::Counted& to, const Grade::Counted& one) {
            to.visits += one.visits;
            to.tests += one.tests;
        };
        const std::vector<std::uint32_t> items = some_items();
        for (const std::uint32_t item : items)
            add(grade_.pairs, traverse(tree_, [&](const Box& box) {
                    return overlaps(box, tree_.boxes()[item]);
                }));
        mean(grade_.pairs, items.size());
        for (std::size_t i = 0; i < n_queries; ++i) {
            const Vec3<float> p = point(2 * i), q = point(2 * i + 1);
            add(grade_.points, traverse(tree_, [&](const Box& box) { return box.contains(p); }));
            Ray<float> ray{p, q - p};
            if (ray.direction == Vec3<float>{})
                ray.direction = {1, 0, 0};
            const RaySlabs slabs(ray);
            add(grade_.rays, traverse(tree_, [&](const Box& box) {
                    return clip(slabs, box, 0, std::numeric_limits<float>::max()).hit();
                }));
        }
        mean(grade_.points, n_queries);
        mean(grade_.rays, n_queries);
    }

    Vec3<float> point(std::size_t i) const {
        auto draw = random_.item(i);
        Vec3<float> p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = static_cast<float>(static_cast<double>(all_.min[axis]) +
                                         draw.uniform() * (static_cast<double>(all_.max[axis]) -
                                                           static_cast<double>(all_.min[axis])));
        return p;
    }

    static constexpr std::uint32_t no_node = ~std::uint32_t{0};
    const NodeTable& tree_;
    Box all_; ///< of the items, whatever the root holds beside them
    Random random_;
    std::vector<std::uint32_t> parent_, node_of_;
    Grade grade_;
};

} // namespace

std::optional<std::string> fault_of(const NodeTable& tree) {
    for (std::size_t i = 0; i < tree.nodes().size(); ++i) {
        const NodeTable::Node& node = tree.nodes()[i];
        for (const std::uint32_t child : tree.children(node))
            if (!tree.given_nodes()[i].contains(tree.given_nodes()[child]))
                return fmt::format("node {} does not hold its child {}", tree.name(i),
                                   tree.name(child));
        for (const std::uint32_t item : tree.items(node))
            if (!tree.given_nodes()[i].contains(tree.given_items()[item]))
                return fmt::format("node {} does not hold item {}", tree.name(i), item);
        if (node.n_children == 0 && node.n_items == 0)
            return fmt::format("node {} has neither children nor items", tree.name(i));
    }
    return std::nullopt;
}

Grade grade(const NodeTable& tree, std::uint64_t seed) { return Grader(tree, seed).grade(); }

} // namespace boxwood::bench
