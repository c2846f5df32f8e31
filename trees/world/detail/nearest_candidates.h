#pragma once

#include "kernels/triangle_distance/distance_kernel.h"
#include "trees/world/detail/pair_frame.h"
#include "trees/world/mesh_pairs.h"

#include <cstddef>
#include <vector>

namespace boxwood::detail {

/// What a search looks for: `stop_at`, a distance that is near enough to end with.
struct DistanceGoal {
    DistanceOptions options;
    double stop_at = 0;
    bool ends_at_first = false; ///< at the first pair that is so near
    bool is_plain = false;      ///< what is measured stands, uncertified
};
/// Throw std::invalid_argument for tolerances and limits that make no sense. goal_within: what
/// decides whether two are at most so far apart.
DistanceGoal goal_of(const DistanceOptions& options);
DistanceGoal goal_within(double tolerance);
/// What is found with goal_within says.
inline MeshWithin within_by(const MeshDistance& found, double tolerance) {
    return {found.found() && found.lo <= tolerance, found.lo, found.hi};
}

/// The nearest pairs of triangles of a search, measured in plain doubles, each with a bound from
/// below; at the end those that may be the nearest are certified.
class NearestCandidates {
  public:
    /// near_contact: distances so small that plain doubles say nothing.
    NearestCandidates(const DistanceGoal& goal, double near_contact);

    double best() const { return best_; } ///< the least that was measured
    /// What is nearer is looked for: the least that was measured, less the tolerances.
    double wanted() const { return wanted_; }
    float wanted_f32() const { return wanted_f32_; } ///< rounded up
    /// They touch, or are as near as is asked.
    bool is_done() const { return is_done_; }

    /// A pair that is the nearest so far or may be: its distance is at least `lower`.
    void offer(const Triangle<double>& a, const Triangle<double>& b, Pair triangles,
               double measured, double lower);
    /// A pair that is measured at once.
    void offer(const Triangle<double>& a, const Triangle<double>& b, Pair triangles);
    /// One that stands as it was measured.
    void offer_plain(const Distance& measured, Pair triangles);
    MeshDistance found() const;

  private:
    struct Candidate {
        Triangle<double> a, b;
        Pair triangles;
        double lower;
    };
    void lower_to(double distance);
    void keep(const Candidate& candidate);
    MeshDistance nearest_of_all() const;

    static constexpr std::size_t max_candidates = 256;

    DistanceGoal goal_;
    double near_contact_, best_, wanted_;
    float wanted_f32_;
    bool is_done_ = false;
    MeshDistance done_;
    std::vector<Candidate> candidates_;
    MeshDistance
        settled_; ///< the nearest of candidates that were certified early, lo of all of them
};

} // namespace boxwood::detail
