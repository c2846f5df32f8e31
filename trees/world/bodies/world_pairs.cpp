/// Candidates: pairs of bodies by their boxes, and which of them may meet.

#include "kernels/arithmetic/rounding.h"
#include "kernels/convex/signed_distance.h"
#include "kernels/primitives/coordinate_limit.h"
#include "trees/queries/regions.h"
#include "trees/world/bodies/detail/sort_pairs.h"
#include "trees/world/bodies/detail/world_state.h"
#include "trees/world/detail/aabb_gap.h"

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

using detail::Stage;
using detail::StageCounts;

/// Whether a half-space or plane may be that near to a box, which is finite.
bool reaches(const PosedShape& unbounded, const Box& box, double tolerance) {
    if (!(tolerance < coordinate_limit))
        return true;
    Pose at;
    convex::Box around;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = double{box.min[axis]}, high = double{box.max[axis]};
        at.translation[axis] = 0.5 * (low + high);
        around.half[axis] =
            std::max(high - at.translation[axis], at.translation[axis] - low) * (1 + 0x1p-50);
    }
    return convex::within(unbounded.shape.convex_shape(), unbounded.pose, around, at,
                          (unbounded.margin + tolerance) * (1 + 0x1p-50))
               .answer != Answer::no;
}

} // namespace

Box detail::wider(const Box& box, double by) {
    const double most = by * (1 + 0x1p-50);
    const Vec3<double> all{most, most, most};
    Aabb<double> wide{Vec3<double>(box.min) - all, Vec3<double>(box.max) + all};
    for (int axis = 0; axis < 3; ++axis) { // and by what the sums are off
        wide.min[axis] -= 0x1p-52 * std::abs(wide.min[axis]);
        wide.max[axis] += 0x1p-52 * std::abs(wide.max[axis]);
    }
    return round_outward(wide);
}

void World::require_tolerance(double tolerance) {
    if (!(tolerance >= 0 && tolerance < coordinate_limit))
        throw std::invalid_argument("a tolerance must be at least 0 and below 2^60, not " +
                                    std::to_string(tolerance));
}

World::Search World::search() const {
    State& state = *state_;
    if (state.tree.is_stale()) {
        const StageCounts::Call call(state.counts, Stage::update, count_);
        state.tree.layout();
    }
    Search found{state.tree.layout(), nullptr, state.tree.wide()};
    if (state.filter.has_groups()) {
        if (state.tree.groups_are_stale()) {
            const StageCounts::Call call(state.counts, Stage::groups, count_);
            state.tree.lane_groups(state.filter.groups());
        }
        found.groups = &state.tree.lane_groups(state.filter.groups());
    }
    return found;
}

void World::update() { search(); }

const PackedLayout& World::layout_for_one() const {
    State& state = *state_;
    if (state.tree.is_stale()) {
        const StageCounts::Call call(state.counts, Stage::update, count_);
        state.tree.layout_for_one();
    }
    return state.tree.layout_for_one();
}

bool World::boxes_are_near(const Search& where, Pair pair, double tolerance) const {
    const Box &a = where.box_of(bodies_, pair.a), &b = where.box_of(bodies_, pair.b);
    return tolerance > 0 ? detail::gap_below(Aabb<double>(a), Aabb<double>(b)) <= tolerance
                         : overlaps(a, b);
}

/// Of two of which one at least is not in the tree.
bool World::are_near(const Search& where, Pair pair, double tolerance) const {
    if (!boxes_are_near(where, pair, tolerance))
        return false;
    const Box &box_a = where.box_of(bodies_, pair.a), &box_b = where.box_of(bodies_, pair.b);
    const auto moves = [&](std::uint32_t body) {
        return !where.moving.empty() && where.moving[body] != 0;
    };
    const bool bounded_a = bodies_[pair.a].shape->is_bounded(),
               bounded_b = bodies_[pair.b].shape->is_bounded();
    if (!bounded_a && bounded_b && !moves(pair.a))
        return reaches(posed(pair.a), box_b, tolerance);
    if (bounded_a && !bounded_b && !moves(pair.b))
        return reaches(posed(pair.b), box_a, tolerance);
    return true;
}

void World::candidates(PairSink& sink, double tolerance, Work* work) const {
    require_tolerance(tolerance);
    const Search where = search();
    StageCounts::Call call(state_->counts, Stage::pairs);
    constexpr std::size_t batch = 256;
    std::vector<Pair> waiting;
    waiting.reserve(batch);
    bool goes_on = true;
    sink.begin(1, true);
    each_pair(where, tolerance, work, [&](Pair pair) {
        ++call.items;
        waiting.push_back(pair);
        if (waiting.size() == batch) {
            goes_on = sink.take(0, waiting);
            waiting.clear();
        }
        return goes_on;
    });
    if (goes_on && !waiting.empty())
        sink.take(0, waiting);
    sink.finish(0);
    sink.end();
}

std::vector<Pair> World::candidates(double tolerance) const {
    std::vector<Pair> found;
    AppendPairs sink(found);
    candidates(sink, tolerance);
    detail::sort_pairs(found, bodies_.size());
    return found;
}

/// Bodies that may meet this one and whose boxes are that near; ascending.
std::vector<std::uint32_t> World::near_to(std::uint32_t body, double tolerance) const {
    const Box box = at(body).box;
    std::vector<std::uint32_t> found;
    if (box.is_empty())
        return found;
    State& state = *state_;
    const Search where{layout_for_one(), nullptr, state.tree.wide()};
    StageCounts::Call call(state.counts, Stage::pairs);
    const auto pair_with = [&](std::uint32_t other) {
        return Pair{std::min(body, other), std::max(body, other)};
    };
    const auto try_one = [&](std::uint32_t other) {
        if (other != body && !bodies_[other].box.is_empty() && state.filter.may_meet(body, other) &&
            are_near(where, pair_with(other), tolerance))
            found.push_back(other);
    };
    if (detail::BodyTree::is_wide(box)) {
        for (std::uint32_t other = 0; other < bodies_.size(); ++other)
            try_one(other);
    } else {
        for (const std::uint32_t other : where.wide)
            try_one(other);
        const Box region = tolerance > 0 ? detail::wider(box, tolerance) : box;
        ForEachPair in_region([&](Pair answer) {
            if (answer.b != body && state.filter.may_meet(body, answer.b) &&
                boxes_are_near(where, pair_with(answer.b), tolerance))
                found.push_back(answer.b);
            return true;
        });
        regions(where.layout, std::span(&region, 1), serial(), in_region);
        std::ranges::sort(found);
    }
    call.items = found.size();
    return found;
}

std::vector<std::uint32_t> World::candidates_of(std::uint32_t body, double tolerance) const {
    require_tolerance(tolerance);
    return near_to(body, tolerance);
}

void World::build_trees(std::span<const Pair> pairs) const {
    std::vector<std::uint32_t> wanted;
    const auto want = [&](std::uint32_t body) {
        if (!bodies_[body].shape->is_built())
            wanted.push_back(body);
    };
    if (pairs.size() < bodies_.size()) {
        for (const Pair pair : pairs)
            want(pair.a), want(pair.b);
    } else { // each body is looked at once
        std::vector<char> is_in_pair(bodies_.size(), 0);
        for (const Pair pair : pairs)
            is_in_pair[pair.a] = is_in_pair[pair.b] = 1;
        for (std::uint32_t body = 0; body < is_in_pair.size(); ++body)
            if (is_in_pair[body])
                want(body);
    }
    if (wanted.empty())
        return;
    std::ranges::sort(wanted);
    wanted.erase(std::ranges::unique(wanted).begin(), wanted.end());
    StageCounts::Call call(state_->counts, Stage::mesh_trees);
    std::atomic<std::size_t> built = 0;
    executor_->for_each(wanted.size(),
                        [&](std::size_t i) { built += bodies_[wanted[i]].shape->build(); });
    call.items = built;
}

} // namespace boxwood
