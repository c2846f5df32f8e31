#include "trees/layouts/binary.h"
#include "trees/layouts/model.h"

#include <algorithm>
#include <vector>

namespace boxwood {

BinaryLayout::BinaryLayout(const Tree& tree, const Executor&) : tree_(tree.size()) {
    std::ranges::copy(tree.nodes, tree_.nodes.begin());
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

LayoutEntry binary_layout() { return layout_entry<BinaryLayout>(); }

} // namespace boxwood
