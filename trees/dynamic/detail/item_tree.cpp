#include "trees/dynamic/detail/item_tree.h"

#include <algorithm>

namespace boxwood::detail {

void ItemTree::clear() {
    boxes_.clear();
    changed_ = {};
    tree_ = {};
    ratio_ = 1;
    unmeasured_ = 0;
}

/// Items that are new to the tree get room for more of them, so that they are put into its order
/// one by one at a cost that does not grow with their number.
bool ItemTree::refresh(double query) {
    if (boxes_.size() > tree_.size()) {
        if (tree_.size() > 0)
            boxes_.resize(boxes_.size() + boxes_.size() / 8);
        reorder();
        return true;
    }
    if (changed_.empty())
        return false;
    const bool are_many = changed_.are_many();
    const std::size_t n = are_many ? boxes_.size() : changed_.items().size();
    if (are_many)
        tree_.refit(boxes_, serial());
    else
        tree_.refit(boxes_, changed_.items());
    changed_.clear();

    constexpr std::size_t some = 64;
    unmeasured_ += n;
    if (unmeasured_ >= some)
        note_ratio();
    constexpr double max_ratio = 1.35;
    if (!(are_many && ratio_ > max_ratio) && !is_worth_order(excess(query)))
        return false;
    reorder();
    return true;
}

void ItemTree::note_ratio() {
    constexpr double max = 1e6; // what was not there came
    ratio_ = std::clamp(tree_.area_ratio(), 1., max);
    unmeasured_ = 0;
}

void ItemTree::reorder() {
    tree_.reorder(boxes_, {}, serial());
    changed_.clear();
    ratio_ = 1;
    unmeasured_ = 0;
    ++orders_;
}

} // namespace boxwood::detail
