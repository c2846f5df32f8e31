#include "trees/layouts/binary.h"
#include "trees/layouts/detail/exact_boxes.h"
#include "trees/layouts/detail/model.h"

#include <algorithm>
#include <vector>

namespace boxwood {
using namespace detail;

template <class Real>
template <class BoxOf>
void BinaryLayoutOf<Real>::make(const Tree& tree, const Executor& executor, const BoxOf& box) {
    tree_ = TreeType(tree.size());
    constexpr std::size_t chunk = 1 << 14;
    const std::size_t n = tree.nodes.size();
    executor.for_each((n + chunk - 1) / chunk, [&](std::size_t c) {
        const std::size_t end = std::min(n, (c + 1) * chunk);
        for (std::size_t i = c * chunk; i < end; ++i)
            tree_.nodes[i] = {box(i), tree.nodes[i].first, tree.nodes[i].count};
    });
    std::ranges::copy(tree.order, tree_.order.begin());
    // In depth-first order the open ancestors are a stack of subtree ends.
    std::vector<std::size_t> ends;
    for (std::size_t i = 0; i < n; ++i) {
        while (!ends.empty() && ends.back() <= i)
            ends.pop_back();
        ends.push_back(i + 2 * std::size_t{tree.nodes[i].count} - 1);
        depth_ = std::max(depth_, ends.size());
    }
}

template <class Real>
BinaryLayoutOf<Real>::BinaryLayoutOf(const Tree& tree, const Executor& executor) {
    make(tree, executor,
         [&](std::size_t node) { return static_cast<Aabb<Real>>(tree.nodes[node].box); });
}

template <class Real>
BinaryLayoutOf<Real>
BinaryLayoutOf<Real>::of_doubles(const Tree& tree, std::span<const Aabb<double>> boxes,
                                 const Executor& executor) requires std::same_as<Real, double> {
    const Buffer<Aabb<double>> exact = exact_boxes(tree, boxes);
    BinaryLayoutOf made;
    made.make(tree, executor,
              [&](std::size_t node) { return static_cast<Aabb<Real>>(exact[node]); });
    return made;
}

template class BinaryLayoutOf<float>;
template class BinaryLayoutOf<double>;

LayoutEntry binary_layout() { return layout_entry<BinaryLayout>(); }
LayoutEntry binary_f64_layout() { return layout_entry<BinaryLayoutF64>(); }

} // namespace boxwood
