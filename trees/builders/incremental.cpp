#include "trees/builders/incremental.h"

#include "trees/dynamic/dynamic_tree.h"

namespace boxwood {

Tree IncrementalBuilder::build(Boxes boxes, const Executor&) const {
    require_valid(boxes);
    DynamicTree tree;
    tree.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        tree.insert(static_cast<std::uint32_t>(i), boxes[i]);
    return tree.to_tree();
}

BuilderEntry incremental_builder() { return builder_entry<IncrementalBuilder>(); }

} // namespace boxwood
