#include "trees/world/bodies/detail/body_tree.h"

#include <algorithm>
#include <cmath>

namespace boxwood::detail {

bool BodyTree::is_wide(const Box& box) {
    constexpr float far = 1e18f; // squares of floats as large do not overflow
    return !(std::min({box.min.x, box.min.y, box.min.z}) >= -far &&
             std::max({box.max.x, box.max.y, box.max.z}) <= far);
}

void BodyTree::set(std::uint32_t body, const Box& box) {
    if (body >= is_wide_.size())
        is_wide_.resize(std::size_t{body} + 1);
    const bool wide = is_wide(box);
    if (wide != (is_wide_[body] != 0)) {
        is_wide_[body] = wide;
        if (wide)
            wide_.push_back(body);
        else
            std::erase(wide_, body);
    }
    tree_.set(body, wide ? Box{} : box);
    is_stale_ = true;
}

void BodyTree::clear() {
    is_wide_.clear();
    wide_.clear();
    tree_.clear();
    lost_ = 0;
    is_stale_ = groups_are_stale_ = true;
}

const PackedLayout& BodyTree::layout_for(double cost) const {
    if (is_stale_) {
        const std::lock_guard lock(changing_);
        if (is_stale_) {
            const std::size_t orders = tree_.orders();
            if (tree_.refresh(cost))
                lost_ = 0;
            else
                lost_ += tree_.excess(cost);
            if (tree_.is_worth_order(lost_) && lost_ > 0) {
                tree_.reorder();
                lost_ = 0;
            }
            if (tree_.orders() != orders)
                groups_are_stale_ = true;
            is_stale_ = false;
        }
    }
    return tree_.layout();
}

const LaneGroups& BodyTree::lane_groups(std::span<const Groups> by_body) const {
    if (groups_are_stale_) {
        const std::lock_guard lock(changing_);
        if (groups_are_stale_) {
            lane_groups_.make(tree_.layout(), by_body);
            groups_are_stale_ = false;
        }
    }
    return lane_groups_;
}

} // namespace boxwood::detail
