#include "trees/layouts/detail/exact_boxes.h"

#include <algorithm>

namespace boxwood::detail {

Buffer<Aabb<double>> exact_boxes(const Tree& tree, std::span<const Aabb<double>> boxes) {
    if (tree.is_split || boxes.size() != tree.size())
        throw std::invalid_argument("exact_boxes: one double box per item of a whole tree is "
                                    "wanted");
    const auto bad = std::ranges::find_if_not(boxes, &Aabb<double>::is_valid);
    if (bad != boxes.end())
        throw InvalidBox(static_cast<std::size_t>(bad - boxes.begin()),
                         "a box needs finite numbers and min <= max");
    Buffer<Aabb<double>> exact(tree.nodes.size());
    for (std::size_t i = tree.nodes.size(); i-- > 0;) // children stand behind their parent
        exact[i] = tree.is_leaf(i) ? boxes[tree.item(i)]
                                   : merge(exact[Tree::left(i)], exact[tree.right(i)]);
    return exact;
}

} // namespace boxwood::detail
