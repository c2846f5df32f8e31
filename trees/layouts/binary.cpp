#include "trees/layouts/binary.h"
#include "trees/layouts/model.h"

#include <algorithm>
#include <vector>

namespace boxwood {

template <class Real>
BinaryLayoutOf<Real>::BinaryLayoutOf(const Tree& tree, const Executor&) : tree_(tree.size()) {
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const TreeNode& node = tree.nodes[i];
        tree_.nodes[i] = {
            {Vec3<Real>(node.box.min), Vec3<Real>(node.box.max)}, node.first, node.count};
    }
    std::ranges::copy(tree.order, tree_.order.begin());
    // In depth-first order the open ancestors are a stack of subtree ends.
    std::vector<std::size_t> ends;
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
        while (!ends.empty() && ends.back() <= i)
            ends.pop_back();
        ends.push_back(i + 2 * std::size_t{tree_.nodes[i].count} - 1);
        depth_ = std::max(depth_, ends.size());
    }
}

template class BinaryLayoutOf<float>;
template class BinaryLayoutOf<double>;

LayoutEntry binary_layout() { return layout_entry<BinaryLayout>(); }

} // namespace boxwood
