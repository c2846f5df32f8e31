#pragma once

#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace boxwood {

/// A layout for the pairs of one tree alone: the boxes in the order of the tree, each compared with
/// all after it. What a layout of one's own has to have, and no more.
class PairsOnlyLayout {
  public:
    static constexpr std::string_view name = "pairs_only";
    static constexpr std::string_view summary = "the boxes as they lie, for the pairs of one tree";

    PairsOnlyLayout(const Tree& tree, const Executor&) {
        for (std::size_t i = 0; i < tree.nodes.size(); ++i)
            if (tree.is_leaf(i)) {
                boxes_.push_back(tree.nodes[i].box);
                items_.push_back(tree.item(i));
            }
    }
    std::size_t bytes() const {
        return boxes_.capacity() * sizeof(Box) + items_.capacity() * sizeof(std::uint32_t);
    }

    friend void self_pairs(const PairsOnlyLayout& layout, const Executor&, PairSink& sink,
                           Work* work = nullptr) {
        sink.begin(1, true);
        for (std::size_t i = 0; i < layout.boxes_.size(); ++i)
            for (std::size_t j = i + 1; j < layout.boxes_.size(); ++j) {
                if (work)
                    ++work->box_tests;
                if (!overlaps(layout.boxes_[i], layout.boxes_[j]))
                    continue;
                const auto [a, b] = std::minmax(layout.items_[i], layout.items_[j]);
                const Pair pair{a, b};
                if (work)
                    ++work->answers;
                if (!sink.take(0, {&pair, 1}))
                    return sink.end();
            }
        sink.end();
    }

  private:
    std::vector<Box> boxes_;
    std::vector<std::uint32_t> items_;
};

} // namespace boxwood
