#include "trees/world/detail/nearest_candidates.h"

#include "kernels/arithmetic/rounding.h"
#include "kernels/triangle_distance/certified.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace boxwood::detail {
namespace {

MeshDistance answer(const Distance& d, Pair triangles) {
    return {d.distance, d.lo, d.hi, d.point_a, d.point_b, triangles};
}

} // namespace

DistanceGoal goal_of(const DistanceOptions& options) {
    if (!(options.relative >= 0 && options.relative < 1) || !(options.absolute >= 0) ||
        !(options.limit >= 0))
        throw std::invalid_argument("a relative tolerance must be in [0, 1), an absolute one and a "
                                    "limit at least 0");
    return {options};
}

DistanceGoal goal_within(double tolerance) {
    if (!(tolerance >= 0))
        throw std::invalid_argument("a tolerance must be at least 0");
    DistanceOptions options;
    options.limit = tolerance * (1 + 0x1p-31) + std::numeric_limits<double>::denorm_min();
    return {options, tolerance, true};
}

NearestCandidates::NearestCandidates(const DistanceGoal& goal, double near_contact)
    : goal_(goal), near_contact_(near_contact), best_(goal.options.limit),
      wanted_(goal.options.limit), wanted_f32_(round_up(wanted_)) {}

void NearestCandidates::lower_to(double distance) {
    best_ = distance;
    const DistanceOptions& o = goal_.options;
    wanted_ =
        std::max(0.0, std::min(distance * (1 - 0x1p-33), distance * (1 - o.relative) - o.absolute));
    wanted_f32_ = round_up(wanted_);
}

void NearestCandidates::offer(const Triangle<double>& a, const Triangle<double>& b, Pair triangles,
                              double measured, double lower) {
    // What is measured in plain doubles is off by some 2^-50 of the size of all: where that is too
    // much of the distance, what lowers the best is made sure of.
    const bool is_rough = measured < best_ && !(measured > 0x1p16 * near_contact_);
    if (!(measured > near_contact_) || is_rough || measured <= goal_.stop_at) {
        offer(a, b, triangles);
        return;
    }
    if (measured < best_)
        lower_to(measured);
    else if (lower >= wanted_)
        return;
    keep({a, b, triangles, std::min(lower, measured)}); // the best one is never left out
}

void NearestCandidates::offer(const Triangle<double>& a, const Triangle<double>& b,
                              Pair triangles) {
    const Distance sure = CertifiedDistance::distance(a, b);
    if (sure.hi == 0 || sure.hi <= goal_.stop_at) {
        done_ = answer(sure, triangles);
        if (sure.hi > 0) // nearer ones may not have been looked at
            done_.lo = 0;
        is_done_ = true;
        return;
    }
    if (sure.hi < best_)
        lower_to(sure.hi);
    else if (sure.lo >= wanted_)
        return;
    keep({a, b, triangles, sure.lo});
}

void NearestCandidates::keep(const Candidate& candidate) {
    if (candidates_.size() == max_candidates) {
        std::erase_if(candidates_, [&](const Candidate& c) { return c.lower > best_; });
        if (candidates_.size() > max_candidates / 2) {
            settled_ = nearest_of_all();
            candidates_.clear();
        }
    }
    candidates_.push_back(candidate);
}

/// The certified nearest, with the least lo of all.
MeshDistance NearestCandidates::nearest_of_all() const {
    MeshDistance nearest = settled_;
    double lo = settled_.lo;
    for (const Candidate& c : candidates_) {
        if (c.lower > best_)
            continue;
        const Distance sure = CertifiedDistance::distance(c.a, c.b);
        lo = std::min(lo, sure.lo);
        if (sure.hi < nearest.hi || (sure.hi == nearest.hi && c.triangles < nearest.triangles))
            nearest = answer(sure, c.triangles);
    }
    nearest.lo = lo;
    return nearest;
}

void NearestCandidates::offer_plain(const Distance& measured, Pair triangles) {
    if (!(measured.distance < best_))
        return;
    lower_to(measured.distance);
    done_ = answer(measured, triangles);
    done_.lo = done_.hi = measured.distance;
    is_done_ = measured.distance <= goal_.stop_at;
}

MeshDistance NearestCandidates::found() const {
    if (is_done_ || (goal_.is_plain && done_.found()))
        return done_;
    MeshDistance nearest = nearest_of_all();
    nearest.lo = std::min({nearest.lo, wanted_, nearest.hi});
    nearest.distance = std::clamp(nearest.distance, nearest.lo, nearest.hi);
    return nearest;
}

} // namespace boxwood::detail
