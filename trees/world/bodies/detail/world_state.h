#pragma once

#include "trees/dynamic/detail/nearest_first.h"
#include "trees/queries/self_pairs.h"
#include "trees/world/bodies/detail/body_filter.h"
#include "trees/world/bodies/detail/body_tree.h"
#include "trees/world/bodies/detail/stage_counts.h"
#include "trees/world/bodies/world.h"

#include <algorithm>
#include <span>
#include <vector>

namespace boxwood {

/// What threads that ask share.
struct World::State {
    explicit State(bool is_timed) : counts(is_timed) {}

    detail::BodyFilter filter;
    detail::BodyTree tree;
    detail::StageCounts counts;
};

namespace detail {
/// Wider by a tolerance, rounded outwards.
Box wider(const Box& box, double by);
} // namespace detail

/// Where pairs are looked for.
struct World::Search {
    const PackedLayout& layout;
    const detail::LaneGroups* groups;       ///< null where no group keeps bodies apart
    std::span<const std::uint32_t> wide;    ///< bodies that are not in the tree
    std::span<const Box> swept{};           ///< by body, where some move
    std::span<const std::uint8_t> moving{}; ///< by body, where some move

    const Box& box_of(std::span<const Body> bodies, std::uint32_t body) const {
        return swept.empty() ? bodies[body].box : swept[body];
    }
};

/// Calls visit(pair) for each pair of bodies that may meet and whose boxes are at most `tolerance`
/// apart, until it says false. First those of bodies that are not in the tree.
template <class Visit>
void World::each_pair(const Search& where, double tolerance, Work* work, const Visit& visit) const {
    const detail::BodyFilter& filter = state_->filter;
    const auto pair_of = [](std::uint32_t a, std::uint32_t b) {
        return Pair{std::min(a, b), std::max(a, b)};
    };
    for (const std::uint32_t a : where.wide)
        for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
            const Box& box = where.box_of(bodies_, b);
            const bool is_once =
                b != a && !box.is_empty() && (!detail::BodyTree::is_wide(box) || a < b);
            if (is_once && filter.may_meet(a, b) && are_near(where, pair_of(a, b), tolerance) &&
                !visit(pair_of(a, b)))
                return;
        }
    if (tolerance == 0 && !(where.groups && where.groups->keep_most_apart())) {
        ForEachPair all([&](Pair pair) { return !filter.may_meet(pair.a, pair.b) || visit(pair); });
        self_pairs(where.layout, serial(), all, work);
        return;
    }
    const float limit = detail::NearestFirst::squared_limit(tolerance);
    detail::NearestFirst(limit, where.groups, work)
        .all_self_pairs(where.layout, [&](std::uint32_t a, std::uint32_t b) {
            const Pair pair = pair_of(a, b);
            return !filter.may_meet(a, b) || !boxes_are_near(where, pair, tolerance) || visit(pair);
        });
}

/// Answers about pairs, whose trees are built, by the threads of the world. The bodies of pairs lie
/// anywhere, and are fetched ahead.
template <class Found, class Decide>
std::vector<Found> World::decided(std::span<const Pair> pairs, const Decide& decide) const {
    constexpr std::size_t some = 16, ahead = 4; // to a task; of pairs
    constexpr std::size_t line = 64;
    const auto fetch = [&](std::uint32_t body) {
        const auto* const bytes = reinterpret_cast<const char*>(&bodies_[body]);
        for (std::size_t at = 0; at < sizeof(Body); at += line)
            __builtin_prefetch(bytes + at);
    };
    std::vector<Found> answers(pairs.size());
    executor_->for_each((pairs.size() + some - 1) / some, [&](std::size_t task) {
        for (std::size_t i = task * some; i < std::min(pairs.size(), (task + 1) * some); ++i) {
            if (i + ahead < pairs.size()) {
                fetch(pairs[i + ahead].a);
                fetch(pairs[i + ahead].b);
            }
            answers[i] = decide(pairs[i]);
        }
    });
    return answers;
}

} // namespace boxwood
