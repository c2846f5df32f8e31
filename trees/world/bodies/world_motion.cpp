/// First contacts: boxes around whole ways, a tree over them in the order of the world's, or where
/// few move the world's own; then conservative advancement.

#include "kernels/arithmetic/rounding.h"
#include "trees/queries/regions.h"
#include "trees/world/bodies/detail/sort_pairs.h"
#include "trees/world/bodies/detail/swept_box.h"
#include "trees/world/bodies/detail/world_state.h"

#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

namespace boxwood {

using detail::Stage;
using detail::StageCounts;

/// Those of which one moves at least, where few do: each asks the tree of the others as they are.
std::vector<Pair> World::pairs_of_few(std::span<const Box> swept,
                                      std::span<const std::uint8_t> moving,
                                      std::span<const std::uint32_t> wide, double tolerance) const {
    const Search where{layout_for_one(), nullptr, wide, swept, moving};
    StageCounts::Call call(state_->counts, Stage::pairs);
    std::vector<std::uint32_t> movers;
    for (std::uint32_t body = 0; body < bodies_.size(); ++body)
        if (moving[body] != 0 && !swept[body].is_empty())
            movers.push_back(body);
    std::vector<Pair> pairs;
    for (const std::uint32_t body : movers) {
        const auto pair_with = [&](std::uint32_t other) {
            return Pair{std::min(body, other), std::max(body, other)};
        };
        const auto try_one = [&](std::uint32_t other) {
            if (!swept[other].is_empty() && state_->filter.may_meet(body, other) &&
                are_near(where, pair_with(other), tolerance))
                pairs.push_back(pair_with(other));
        };
        for (const std::uint32_t other : movers)
            if (other > body)
                try_one(other);
        if (detail::BodyTree::is_wide(swept[body])) {
            for (std::uint32_t other = 0; other < bodies_.size(); ++other)
                if (moving[other] == 0)
                    try_one(other);
            continue;
        }
        for (const std::uint32_t other : wide)
            if (moving[other] == 0)
                try_one(other);
        const Box region = tolerance > 0 ? detail::wider(swept[body], tolerance) : swept[body];
        ForEachPair in_region([&](Pair answer) {
            const std::uint32_t other = answer.b;
            if (moving[other] == 0 && state_->filter.may_meet(body, other) &&
                boxes_are_near(where, pair_with(other), tolerance))
                pairs.push_back(pair_with(other));
            return true;
        });
        regions(where.layout, std::span(&region, 1), serial(), in_region);
    }
    detail::sort_pairs(pairs, bodies_.size());
    call.items = pairs.size();
    return pairs;
}

std::vector<BodyFirstContact> World::first_contacts(std::span<const BodyMotion> motions,
                                                    const ContinuousOptions& options) const {
    require_tolerance(options.tolerance);
    std::vector<std::uint8_t> moving(bodies_.size());
    std::map<std::uint32_t, BodyMotion> ways;
    for (const BodyMotion& motion : motions) {
        at(motion.body);
        if (moving[motion.body]++ != 0)
            throw std::invalid_argument("body " + std::to_string(motion.body) + " has two motions");
        ways[motion.body] = {motion.body, checked_pose(motion.to), motion.path};
    }
    const auto moved = [&](std::uint32_t body) -> MovingShape {
        const Body& of = bodies_[body];
        if (moving[body] == 0)
            return {*of.shape, of.pose, of.pose, MotionPath::linear, of.margin};
        const BodyMotion& way = ways.at(body);
        return {*of.shape, of.pose, way.to, way.path, of.margin};
    };

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
    if (motions.size() <= bodies_.size() / 16) {
        pairs = pairs_of_few(swept, moving, wide, options.tolerance);
    } else {
        const Search still = search();
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
        detail::sort_pairs(pairs, bodies_.size());
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
