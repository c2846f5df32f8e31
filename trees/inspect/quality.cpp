#include "trees/inspect/quality.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace boxwood {
namespace {

double extent(const Box& b, int axis) {
    return static_cast<double>(b.max[axis]) - static_cast<double>(b.min[axis]);
}

Box intersect(const Box& a, const Box& b) { return {max(a.min, b.min), min(a.max, b.max)}; }

/// Ratios of box sizes to the size of one box, by area, or by length where that box has no area.
class SizeRatio {
  public:
    explicit SizeRatio(const Box& whole) : by_area_(whole.half_area() > 0), whole_(size(whole)) {}
    double operator()(const Box& part) const {
        return part.is_empty() ? 0 : whole_ > 0 ? size(part) / whole_ : 1;
    }

  private:
    double size(const Box& b) const {
        return by_area_ ? b.half_area() : extent(b, 0) + extent(b, 1) + extent(b, 2);
    }
    bool by_area_;
    double whole_;
};

/// Area of the faces of `item` inside the closed box `node`, which must overlap it.
double surface_inside(const Box& item, const Box& node) {
    const Box common = intersect(item, node);
    double area = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int faces =
            (common.min[axis] == item.min[axis]) + (common.max[axis] == item.max[axis]);
        area += faces * extent(common, (axis + 1) % 3) * extent(common, (axis + 2) % 3);
    }
    return area;
}

/// A step that visits all of 0 .. n - 1 from any start, modulo n, and spreads each prefix evenly:
/// the golden section of n, moved to the next number without a common factor.
std::size_t golden_step(std::size_t n) {
    auto step = static_cast<std::size_t>(0.6180339887498949 * static_cast<double>(n));
    while (std::gcd(step, n) != 1)
        ++step;
    return step;
}

/// Visits the tree once per item, subtrees that miss the item's box left out, until `epo_visits`
/// are spent; at least one item, so at most 2n - 1 visits more. Items are taken by the golden step.
void measure_epo(const Tree& tree, Boxes boxes, const QualityModel& model, Quality& q) {
    const std::size_t n = tree.size();
    std::vector<Box> parts(tree.is_split ? n : 0);
    if (tree.is_split)
        for (const TreeNode& node : tree.nodes)
            if (node.count == 1)
                parts[node.first] = node.box;
    const auto box_of_slot = [&](std::size_t s) {
        return tree.is_split ? parts[s] : boxes[tree.order[s]];
    };
    double outside = 0, surface = 0;
    std::uint64_t visits = 0;
    std::vector<std::uint32_t> stack;
    std::size_t slot = 0;
    for (const std::size_t step = golden_step(n); q.epo_items < n && visits < model.epo_visits;
         ++q.epo_items, slot = (slot + step) % n) {
        const Box item = box_of_slot(slot);
        surface += 2 * item.half_area();
        stack.assign(1, 0);
        while (!stack.empty()) {
            const std::size_t i = stack.back();
            const TreeNode& node = tree.nodes[i];
            stack.pop_back();
            ++visits;
            if (!overlaps(item, node.box))
                continue;
            const bool leaf = node.count == 1;
            if (slot < node.first || slot - node.first >= node.count)
                outside += (leaf ? model.c_isect : model.c_trav) * surface_inside(item, node.box);
            if (!leaf) {
                stack.push_back(static_cast<std::uint32_t>(tree.right(i)));
                stack.push_back(static_cast<std::uint32_t>(Tree::left(i)));
            }
        }
    }
    q.epo = surface > 0 ? outside / surface : 0;
}

} // namespace

Quality quality(const Tree& tree, Boxes boxes, const QualityModel& model) {
    const std::size_t n = tree.size();
    if (boxes.size() != n && !tree.is_split)
        throw std::invalid_argument("quality: the tree holds " + std::to_string(n) +
                                    " items, but there are " + std::to_string(boxes.size()) +
                                    " boxes");
    Quality q;
    if (n == 0)
        return q;
    q.n_nodes = tree.nodes.size();
    q.n_leaves = n;
    q.leaf_mean = 1;
    q.bytes = tree.nodes.bytes() + tree.order.bytes();

    const SizeRatio to_root(tree.nodes[0].box);
    double inner = 0, leaves = 0, shared = 0, depths = 0;
    std::vector<std::uint32_t> depth(q.n_nodes, 0);
    for (std::size_t i = 0; i < q.n_nodes; ++i) {
        const Box& box = tree.nodes[i].box;
        if (tree.is_leaf(i)) {
            leaves += to_root(box);
            depths += depth[i];
            q.depth_max = std::max<std::uint64_t>(q.depth_max, depth[i]);
            continue;
        }
        const std::size_t left = Tree::left(i), right = tree.right(i);
        depth[left] = depth[right] = depth[i] + 1;
        inner += to_root(box);
        shared += SizeRatio(box)(intersect(tree.nodes[left].box, tree.nodes[right].box));
    }
    q.depth_mean = depths / static_cast<double>(n);
    q.sah_cost = model.c_trav * inner + model.c_isect * leaves;
    q.overlap = n > 1 ? shared / static_cast<double>(n - 1) : 0;
    measure_epo(tree, boxes, model, q);
    return q;
}

} // namespace boxwood
