/// First contacts: boxes around whole ways, a tree over them in the order of the world's, then
/// conservative advancement.

#include "kernels/arithmetic/rounding.h"
#include "trees/world/bodies/detail/swept_box.h"
#include "trees/world/bodies/detail/world_state.h"

#include <stdexcept>
#include <string>
#include <tuple>

namespace boxwood {

using detail::Stage;
using detail::StageCounts;

std::vector<BodyFirstContact> World::first_contacts(std::span<const BodyMotion> motions,
                                                    const ContinuousOptions& options) const {
    require_tolerance(options.tolerance);
    std::vector<std::uint8_t> moving(bodies_.size());
    std::vector<BodyMotion> ways(bodies_.size());
    for (const BodyMotion& motion : motions) {
        at(motion.body);
        if (moving[motion.body]++ != 0)
            throw std::invalid_argument("body " + std::to_string(motion.body) + " has two motions");
        ways[motion.body] = motion;
        ways[motion.body].to = checked_pose(motion.to);
    }
    const auto moved = [&](std::uint32_t body) -> MovingShape {
        const Body& of = bodies_[body];
        if (moving[body] == 0)
            return {*of.shape, of.pose, of.pose, MotionPath::linear, of.margin};
        return {*of.shape, of.pose, ways[body].to, ways[body].path, of.margin};
    };

    const Search still = search();
    std::vector<Box> swept(bodies_.size());
    std::vector<std::uint32_t> wide;
    std::vector<Pair> pairs;
    {
        StageCounts::Call call(state_->counts, Stage::sweep, motions.size());
        for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
            const bool is_swept = moving[body] != 0 && bodies_[body].shape->is_bounded();
            swept[body] = bodies_[body].box;
            if (is_swept && !bodies_[body].shape->empty())
                swept[body] = round_outward(detail::swept_box(moved(body)));
            if (detail::BodyTree::is_wide(swept[body]))
                wide.push_back(body);
        }
    }
    {
        StageCounts::Call call(state_->counts, Stage::pairs);
        std::vector<Box> in_tree(still.layout.size());
        for (std::uint32_t body = 0; body < bodies_.size(); ++body)
            if (!detail::BodyTree::is_wide(swept[body]))
                in_tree[body] = swept[body];
        const PackedLayout layout =
            PackedLayout::of_order(in_tree, still.layout.items().first(in_tree.size()), serial());
        each_pair({layout, still.groups, wide, swept, moving}, options.tolerance, nullptr,
                  [&](Pair pair) {
                      if ((moving[pair.a] | moving[pair.b]) != 0)
                          pairs.push_back(pair);
                      return true;
                  });
        std::ranges::sort(pairs);
        call.items = pairs.size();
    }

    build_trees(pairs);
    const StageCounts::Call call(state_->counts, Stage::first_contact, pairs.size());
    const auto answers = decided<FirstContact>(
        pairs, [&](Pair p) { return first_contact(moved(p.a), moved(p.b), options); });
    std::vector<BodyFirstContact> found;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (answers[i].hit != Answer::no)
            found.push_back({pairs[i], answers[i]});
    std::ranges::sort(found, {}, [](const BodyFirstContact& one) {
        return std::tuple(one.contact.t_hit, one.contact.t_free, one.bodies);
    });
    return found;
}

} // namespace boxwood
