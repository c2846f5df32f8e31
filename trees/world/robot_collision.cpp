#include "trees/world/robot_collision.h"

#include "trees/world/detail/aabb_gap.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

namespace boxwood {

RobotSelfCollision::RobotSelfCollision(const Robot& robot, const LinkBoxes& boxes,
                                       const AllowedPairs& allowed,
                                       const LinkNarrowPhase& narrow_phase)
    : robot_(&robot), link_boxes_(&boxes), narrow_phase_(&narrow_phase),
      poses_(robot.links().size()), boxes_(robot.links().size()) {
    if (allowed.items() != robot.links().size())
        throw std::invalid_argument("the allowed pairs are of " + std::to_string(allowed.items()) +
                                    " items; the robot has " +
                                    std::to_string(robot.links().size()) + " links");
    const auto links = boxes.links();
    for (std::size_t i = 0; i < links.size(); ++i)
        for (std::size_t j = i + 1; j < links.size(); ++j) {
            pairs_.push_back({links[i], links[j]});
            if (!allowed.allows(links[i], links[j]))
                pairs_to_test_.push_back({links[i], links[j]});
        }
}

void RobotSelfCollision::place(std::span<const double> values) {
    robot_->poses(values, poses_);
    link_boxes_->boxes(poses_, boxes_);
}

bool RobotSelfCollision::collides(std::span<const double> values) {
    place(values);
    const auto touch = [&](std::size_t i) {
        const auto [a, b] = pairs_to_test_[i];
        return overlaps(boxes_[a], boxes_[b]) && narrow_phase_->collide(a, b, poses_);
    };
    const std::size_t n = pairs_to_test_.size(), first = touched_last_;
    if (first < n && touch(first))
        return true;
    for (std::size_t i = 0; i < n; ++i)
        if (i != first && touch(i)) {
            touched_last_ = i;
            return true;
        }
    return false;
}

const SelfCollision& RobotSelfCollision::check(std::span<const double> values) {
    place(values);
    answer_.candidates.clear();
    answer_.tested.clear();
    answer_.colliding.clear();
    const auto may_touch = [&](Pair p) { return overlaps(boxes_[p.a], boxes_[p.b]); };
    std::ranges::copy_if(pairs_, std::back_inserter(answer_.candidates), may_touch);
    std::ranges::copy_if(pairs_to_test_, std::back_inserter(answer_.tested), may_touch);
    std::ranges::copy_if(answer_.tested, std::back_inserter(answer_.colliding),
                         [&](Pair p) { return narrow_phase_->collide(p.a, p.b, poses_); });
    find_least();
    return answer_;
}

/// The pairs by the gaps of their boxes: none can be nearer than its gap.
void RobotSelfCollision::find_least() {
    answer_.nearest.reset();
    answer_.least = {};
    if (!answer_.colliding.empty()) {
        answer_.nearest = answer_.colliding.front();
        answer_.least = {0, 0, 0};
        return;
    }
    by_gap_.clear();
    for (const Pair p : pairs_to_test_)
        by_gap_.push_back({detail::gap_below(boxes_[p.a], boxes_[p.b]), p});
    std::ranges::stable_sort(by_gap_, {}, &Near::gap);
    LinkDistance& least = answer_.least;
    for (const auto& [gap, p] : by_gap_) {
        if (gap >= least.hi)
            break;
        const LinkDistance found = narrow_phase_->distance(p.a, p.b, poses_, least.hi);
        if (!answer_.nearest || found.distance < least.distance) {
            answer_.nearest = p;
            least.distance = found.distance;
        }
        least.lo = std::min(least.lo, found.lo);
        least.hi = std::min(least.hi, found.hi);
    }
}

} // namespace boxwood
