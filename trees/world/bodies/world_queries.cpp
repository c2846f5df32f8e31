/// Answers about pairs: candidates, then the shapes decide.

#include "trees/world/bodies/detail/world_state.h"
#include "trees/world/detail/aabb_gap.h"
#include "trees/world/detail/nearest_candidates.h"

#include <stdexcept>
#include <utility>

namespace boxwood {
namespace {

using detail::Stage;
using detail::StageCounts;

/// The pairs whose answer is yes or may be, in order.
std::vector<Pair> not_denied(std::span<const Pair> pairs, std::span<const Answer> answers) {
    std::vector<Pair> found;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (answers[i] != Answer::no)
            found.push_back(pairs[i]);
    return found;
}

Pair sorted(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// What was found of the two in their order, as of a and b.
BodyDistance of_bodies(BodyDistance found, std::uint32_t a, std::uint32_t b) {
    found.bodies = {a, b};
    if (a > b) {
        std::swap(found.point_a, found.point_b);
        std::swap(found.parts.a, found.parts.b);
    }
    return found;
}

std::vector<Pair> pairs_with(std::uint32_t body, std::span<const std::uint32_t> others) {
    std::vector<Pair> pairs;
    for (const std::uint32_t other : others)
        pairs.push_back(sorted(body, other));
    return pairs;
}

} // namespace

std::vector<Pair> World::ready_pairs(double tolerance) const {
    std::vector<Pair> pairs = candidates(tolerance);
    build_trees(pairs);
    return pairs;
}

PosedShape World::posed(std::uint32_t body) const {
    const Body& of = at(body);
    return {*of.shape, of.pose, of.margin};
}

Answer World::collide(std::uint32_t a, std::uint32_t b) const {
    const Pair pair = sorted(a, b);
    return boxwood::collide(posed(pair.a), posed(pair.b));
}

Answer World::within(std::uint32_t a, std::uint32_t b, double tolerance) const {
    const Pair pair = sorted(a, b);
    return boxwood::within(posed(pair.a), posed(pair.b), tolerance);
}

BodyDistance World::distance(std::uint32_t a, std::uint32_t b,
                             const DistanceOptions& options) const {
    const Pair pair = sorted(a, b);
    DistanceOptions of_pair = options;
    if (a > b && options.start)
        of_pair.start = Pair{options.start->b, options.start->a};
    return of_bodies(boxwood::distance(posed(pair.a), posed(pair.b), of_pair), a, b);
}

BodyDistance World::signed_distance(std::uint32_t a, std::uint32_t b, double tolerance) const {
    const Pair pair = sorted(a, b);
    return of_bodies(boxwood::signed_distance(posed(pair.a), posed(pair.b), tolerance), a, b);
}

std::vector<BodyContact> World::contacts(std::uint32_t a, std::uint32_t b,
                                         const ContactOptions& options) const {
    const Pair pair = sorted(a, b);
    std::vector<BodyContact> found = boxwood::contacts(posed(pair.a), posed(pair.b), options);
    for (BodyContact& contact : found) {
        contact.bodies = {a, b};
        if (a > b) {
            contact.normal = -contact.normal;
            std::swap(contact.parts.a, contact.parts.b);
        }
    }
    return found;
}

std::vector<Pair> World::collisions() const {
    const std::vector<Pair> pairs = ready_pairs();
    const StageCounts::Call call(state_->counts, Stage::collide, pairs.size());
    return not_denied(pairs, decided<Answer>(pairs, [&](Pair p) { return collide(p.a, p.b); }));
}

std::vector<std::uint32_t> World::collisions_of(std::uint32_t body) const {
    const std::vector<std::uint32_t> others = near_to(body, 0);
    const std::vector<Pair> pairs = pairs_with(body, others);
    build_trees(pairs);
    const StageCounts::Call call(state_->counts, Stage::collide, others.size());
    const auto answers = decided<Answer>(pairs, [&](Pair p) { return collide(p.a, p.b); });
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < others.size(); ++i)
        if (answers[i] != Answer::no)
            found.push_back(others[i]);
    return found;
}

std::optional<Pair> World::any_collision() const {
    const Search where = search();
    StageCounts::Call call(state_->counts, Stage::collide);
    std::optional<Pair> found;
    each_pair(where, 0, nullptr, [&](Pair pair) {
        ++call.items;
        build_trees({&pair, 1});
        if (collide(pair.a, pair.b) == Answer::no)
            return true;
        found = pair;
        return false;
    });
    state_->counts.note(Stage::pairs, call.items);
    return found;
}

/// The nearest pair so far, and the least that any pair may be apart.
struct World::Nearest {
    Nearest(const World& of, const DistanceOptions& options, Work* counted)
        : world(of), work(counted), relative(options.relative), absolute(options.absolute),
          most(options.limit), squared(detail::NearestFirst::squared_limit(most)) {
        detail::goal_of(options); // throws
    }

    /// False once nothing can be nearer.
    bool offer(Pair pair) {
        if (!world.state_->filter.may_meet(pair.a, pair.b))
            return true;
        const Box &a = world.bodies_[pair.a].box, &b = world.bodies_[pair.b].box;
        if (!(detail::gap_below(Aabb<double>(a), Aabb<double>(b)) < most))
            return true;
        ++offered;
        world.build_trees({&pair, 1});
        DistanceOptions options;
        options.relative = relative;
        options.absolute = absolute;
        options.limit = most;
        BodyDistance found =
            boxwood::distance(world.posed(pair.a), world.posed(pair.b), options, work);
        found.bodies = pair;
        if (!found.found() || !(found.lo < most))
            return true;
        lo = std::min(lo, found.lo);
        if (!best || found.hi < best->hi)
            best = found;
        // What is beyond that makes the answer no farther than is allowed.
        most = std::max(0.0, std::min(most, found.hi * (1 - relative) - absolute));
        squared = detail::NearestFirst::squared_limit(most);
        return most > 0;
    }
    std::optional<BodyDistance> answer() const {
        std::optional<BodyDistance> nearest = best;
        if (nearest)
            nearest->lo = std::min({nearest->lo, lo, most});
        return nearest;
    }

    const World& world;
    Work* work;
    double relative, absolute;
    double most; ///< what is nearer is looked for
    float squared;
    double lo = std::numeric_limits<double>::infinity();
    std::optional<BodyDistance> best;
    std::size_t offered = 0;
};

std::optional<BodyDistance> World::least_distance(double limit) const {
    return least_distance({.limit = limit});
}

std::optional<BodyDistance> World::least_distance(const DistanceOptions& options,
                                                  Work* work) const {
    Nearest nearest(*this, options, work);
    const Search where = search();
    StageCounts::Call call(state_->counts, Stage::distance);
    const auto offer = [&](std::uint32_t a, std::uint32_t b) {
        return nearest.offer(sorted(a, b));
    };
    bool goes_on =
        detail::NearestFirst(nearest.squared, where.groups).self_pairs(where.layout, offer);
    for (std::size_t i = 0; i < where.wide.size() && goes_on; ++i)
        for (std::uint32_t b = 0; b < bodies_.size() && goes_on; ++b) {
            const std::uint32_t a = where.wide[i];
            const Box& box = bodies_[b].box;
            const bool is_once =
                b != a && !box.is_empty() && (!detail::BodyTree::is_wide(box) || a < b);
            if (is_once && are_near(where, sorted(a, b), nearest.most))
                goes_on = offer(a, b);
        }
    call.items = nearest.offered;
    state_->counts.note(Stage::pairs, nearest.offered);
    return nearest.answer();
}

std::optional<BodyDistance> World::least_distance_of(std::uint32_t body, double limit) const {
    return least_distance_of(body, {.limit = limit});
}

std::optional<BodyDistance>
World::least_distance_of(std::uint32_t body, const DistanceOptions& options, Work* work) const {
    Nearest nearest(*this, options, work);
    const Box box = at(body).box;
    if (box.is_empty())
        return std::nullopt;
    const Search where = search();
    StageCounts::Call call(state_->counts, Stage::distance);
    const auto offer = [&](std::uint32_t other, std::uint32_t) {
        return other == body || nearest.offer(sorted(body, other));
    };
    bool goes_on = true;
    const bool is_wide = detail::BodyTree::is_wide(box);
    if (!is_wide)
        goes_on = detail::NearestFirst(nearest.squared).near_box(where.layout, box, offer);
    for (std::uint32_t other = 0; other < bodies_.size() && goes_on; ++other) {
        const Box& its = bodies_[other].box;
        if (other != body && !its.is_empty() && (is_wide || detail::BodyTree::is_wide(its)) &&
            are_near(where, sorted(body, other), nearest.most))
            goes_on = offer(other, 0);
    }
    call.items = nearest.offered;
    state_->counts.note(Stage::pairs, nearest.offered);
    return nearest.answer();
}

std::vector<Pair> World::within(double tolerance) const {
    const std::vector<Pair> pairs = ready_pairs(tolerance);
    const StageCounts::Call call(state_->counts, Stage::within, pairs.size());
    return not_denied(pairs,
                      decided<Answer>(pairs, [&](Pair p) { return within(p.a, p.b, tolerance); }));
}

std::vector<BodyDistance> World::distances(double tolerance) const {
    const std::vector<Pair> pairs = ready_pairs(tolerance);
    const StageCounts::Call call(state_->counts, Stage::distance, pairs.size());
    DistanceOptions options; // at the tolerance is within
    options.limit = tolerance * (1 + 0x1p-31) + std::numeric_limits<double>::denorm_min();
    auto found = decided<BodyDistance>(pairs, [&](Pair p) { return distance(p.a, p.b, options); });
    std::erase_if(found, [&](const BodyDistance& d) { return !d.found() || d.lo > tolerance; });
    return found;
}

std::vector<BodyContact> World::contacts(const ContactOptions& options) const {
    const std::vector<Pair> pairs = ready_pairs();
    const StageCounts::Call call(state_->counts, Stage::contacts, pairs.size());
    std::vector<BodyContact> all;
    for (const auto& of_pair : decided<std::vector<BodyContact>>(
             pairs, [&](Pair p) { return contacts(p.a, p.b, options); }))
        all.insert(all.end(), of_pair.begin(), of_pair.end());
    return all;
}

} // namespace boxwood
