#include "trees/optimizers/refit.h"

namespace boxwood {

std::size_t refit(Tree& tree, Boxes boxes) {
    if (boxes.size() != tree.size())
        throw std::invalid_argument("refit: the tree holds " + std::to_string(tree.size()) +
                                    " items, but there are " + std::to_string(boxes.size()) +
                                    " boxes; give one per item");
    for (const std::uint32_t item : tree.order)
        if (item >= boxes.size())
            throw std::invalid_argument("refit: the tree holds item " + std::to_string(item) +
                                        ", but there are " + std::to_string(boxes.size()) +
                                        " boxes; number the items from 0 without gaps");
    require_valid(boxes);

    std::size_t changed = 0;
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
        const Box box = tree.is_leaf(i)
                            ? boxes[tree.item(i)]
                            : merge(tree.nodes[Tree::left(i)].box, tree.nodes[tree.right(i)].box);
        changed += !(tree.nodes[i].box == box);
        tree.nodes[i].box = box;
    }
    return changed;
}

} // namespace boxwood
