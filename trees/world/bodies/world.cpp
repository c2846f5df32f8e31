/// Bodies and which may meet. Each change is taken by the boxes and the filter at once; the tree
/// follows with the next query.

#include "trees/world/bodies/world.h"

#include "kernels/arithmetic/rounding.h"
#include "kernels/primitives/coordinate_limit.h"
#include "kernels/suggest.h"
#include "trees/queries/box_queries.h"
#include "trees/world/bodies/detail/world_state.h"

#include <algorithm>
#include <stdexcept>

namespace boxwood {
namespace {

using detail::Groups;
using detail::Stage;

/// Wider by the margin, rounded outwards. bounds_at has room for the roundings of both sums.
Box box_of(Aabb<double> box, double margin) {
    if (box.is_empty())
        return {};
    const double by = margin * (1 + 0x1p-50);
    box.min = box.min - Vec3<double>{by, by, by};
    box.max = box.max + Vec3<double>{by, by, by};
    return round_outward(box);
}

void require_margin(double margin) {
    if (!(margin >= 0 && margin < coordinate_limit))
        throw std::invalid_argument("a margin must be at least 0 and below 2^60, not " +
                                    std::to_string(margin));
}

} // namespace

World::World(const WorldOptions& options)
    : executor_(detail::executor_of(options.executor, options.threads)),
      state_(std::make_unique<State>(options.is_timed)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

const World::Body& World::at(std::uint32_t body) const {
    if (!contains(body))
        throw std::invalid_argument("body " + std::to_string(body) + " is not in the world");
    return bodies_[body];
}

std::uint32_t World::insert(BodyShape shape, const Pose& pose, const BodyOptions& options) {
    const Pose where = checked_pose(pose);
    require_margin(options.margin);
    if (!options.name.empty() && names_.contains(options.name))
        throw std::invalid_argument("two bodies have the name '" + options.name + "'");
    if (bodies_.size() >= max_items && free_.empty())
        throw std::length_error("a world has fewer than " + std::to_string(max_items) + " bodies");
    auto body = static_cast<std::uint32_t>(bodies_.size());
    if (free_.empty()) {
        bodies_.emplace_back();
    } else {
        body = free_.back();
        free_.pop_back();
    }
    if (!options.name.empty())
        names_.emplace(options.name, body);
    bodies_[body] = {std::move(shape), where, options.margin, {}, options.name};
    ++count_;
    state_->filter.add(body, {options.group, options.mask});
    state_->tree.note_groups();
    place(body);
    return body;
}

void World::remove(std::uint32_t body) {
    Body& gone = at(body);
    if (!gone.name.empty())
        names_.erase(gone.name);
    gone = {};
    --count_;
    free_.push_back(body);
    state_->filter.remove(body);
    state_->tree.note_groups();
    state_->tree.set(body, Box{});
}

void World::clear() {
    bodies_.clear();
    free_.clear();
    names_.clear();
    count_ = 0;
    state_->filter.clear();
    state_->tree.clear();
}

void World::place(std::uint32_t body) {
    const detail::StageCounts::Call call(state_->counts, Stage::fit, 1);
    Body& placed = bodies_[body];
    placed.box = box_of(placed.shape->bounds_at(placed.pose), placed.margin);
    state_->tree.set(body, placed.box);
}

void World::set_pose(std::uint32_t body, const Pose& pose) {
    at(body).pose = checked_pose(pose);
    place(body);
}

void World::set_poses(std::span<const std::uint32_t> bodies, std::span<const Pose> poses) {
    if (bodies.size() != poses.size())
        throw std::invalid_argument(std::to_string(bodies.size()) + " bodies and " +
                                    std::to_string(poses.size()) + " poses: one each is wanted");
    std::vector<Pose> checked;
    checked.reserve(poses.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        at(bodies[i]);
        checked.push_back(checked_pose(poses[i]));
    }
    const detail::StageCounts::Call call(state_->counts, Stage::fit, bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        Body& placed = bodies_[bodies[i]];
        placed.pose = checked[i];
        placed.box = box_of(placed.shape->bounds_at(placed.pose), placed.margin);
        state_->tree.set(bodies[i], placed.box);
    }
}

void World::set_margin(std::uint32_t body, double margin) {
    require_margin(margin);
    at(body).margin = margin;
    place(body);
}

void World::set_groups(std::uint32_t body, std::uint32_t group, std::uint32_t mask) {
    at(body);
    state_->filter.set_groups(body, {group, mask});
    state_->tree.note_groups();
}

std::vector<std::uint32_t> World::bodies() const {
    std::vector<std::uint32_t> all;
    for (std::uint32_t body = 0; body < bodies_.size(); ++body)
        if (contains(body))
            all.push_back(body);
    return all;
}

std::uint32_t World::find(std::string_view name) const {
    if (const auto found = names_.find(name); found != names_.end())
        return found->second;
    std::vector<std::string_view> known;
    for (const Body& body : bodies_)
        if (!body.name.empty())
            known.emplace_back(body.name);
    throw std::invalid_argument(unknown_name("body", name, known));
}

void World::allow(std::uint32_t a, std::uint32_t b, AllowedReason reason, std::string note) {
    at(a);
    at(b);
    state_->filter.allow(a, b, reason, std::move(note));
}

void World::disallow(std::uint32_t a, std::uint32_t b) {
    at(a);
    at(b);
    state_->filter.disallow(a, b);
}

void World::allow(const AllowedPairs& pairs) {
    std::vector<AllowedPair> of_bodies = pairs.pairs();
    for (AllowedPair& pair : of_bodies) {
        pair.a = find(pairs.name(pair.a));
        pair.b = find(pairs.name(pair.b));
    }
    for (AllowedPair& pair : of_bodies)
        allow(pair.a, pair.b, pair.reason, std::move(pair.note));
}

std::optional<AllowedReason> World::allowed(std::uint32_t a, std::uint32_t b) const {
    at(a);
    at(b);
    return state_->filter.reason(a, b);
}

std::vector<AllowedPair> World::allowed_pairs() const { return state_->filter.pairs(); }

bool World::may_meet(std::uint32_t a, std::uint32_t b) const {
    at(a);
    at(b);
    return a != b && state_->filter.may_meet(a, b);
}

} // namespace boxwood
