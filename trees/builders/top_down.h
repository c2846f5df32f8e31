#pragma once

#include "trees/builders/detail/prim8.h"
#include "trees/builders/detail/top_down_loop.h"
#include "trees/optimizers/refit.h"
#include "trees/tree.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

namespace boxwood {

/// An item on its way to a leaf: item(), box() and doubled_centre(axis).
using BuildItem = detail::Prim8;

namespace detail {

/// The splitter over one array of items that is given no more than a split.
template <class Split> class ItemSplitter {
  public:
    using Part = Subtree;

    ItemSplitter(Boxes boxes, const Executor& executor, const Split& split)
        : split_(split), items_(boxes, executor), tree_(boxes.size()),
          max_depth_(2 * static_cast<std::uint32_t>(std::bit_width(boxes.size())) + 32) {}

    Tree build(Boxes boxes, const Executor& executor) {
        if (boxes.empty())
            return std::move(tree_);
        const auto n = static_cast<std::uint32_t>(boxes.size());
        build_by_splitter(*this, Part{0, 0, n, 0}, executor, std::max(2048u, n / 32));
        refit(tree_, boxes);
        return std::move(tree_);
    }

    bool is_split(const Part& part) const { return part.count > 1; }
    Halves<Part> split(const Part& part) {
        write(part);
        const std::span<Prim8> items = items_.prims.span().subspan(part.first, part.count);
        const std::size_t n_left = part.count == 2           ? 1
                                   : part.depth > max_depth_ ? halve(items)
                                                             : split_(items);
        return children_of(part, static_cast<std::uint32_t>(n_left));
    }
    void finish(const Part& part) {
        write(part);
        tree_.order[part.first] = items_.prims[part.first].item();
    }
    void build(const Part& part) { build_below(*this, part); }

  private:
    /// All but the box, which `refit` makes.
    void write(const Part& part) { tree_.nodes[part.node] = {{}, part.first, part.count}; }

    const Split& split_;
    Prims8 items_;
    Tree tree_;
    std::uint32_t max_depth_;
};

} // namespace detail

/// A top-down build by a split of one's own: `split(std::span<BuildItem>) -> std::size_t`
/// rearranges three or more items and says how many go left, in [1, n - 1]. A branch deeper than
/// 2 log2(n) + 32 is split at the median from there on, which bounds every depth by 3 log2(n) + 33.
/// n = 0 gives an empty tree; throws InvalidBox for a bad box.
template <class Split>
Tree build_top_down(Boxes boxes, const Executor& executor, const Split& split) {
    return detail::ItemSplitter<Split>(boxes, executor, split).build(boxes, executor);
}

} // namespace boxwood
