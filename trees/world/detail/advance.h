#pragma once

#include "trees/world/continuous.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace boxwood::detail {

inline double size_of(const Aabb<float>& box) {
    return length(Vec3<double>(box.max) - Vec3<double>(box.min));
}

/// The greatest |coordinate| that what is in a box comes to in a pose, or more.
inline double reach_of(const Aabb<float>& box, const Pose& pose) {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
        reach += std::max(std::abs(double{box.min[axis]}), std::abs(double{box.max[axis]})) +
                 std::abs(pose.translation[axis]);
    return reach;
}

/// What bounds two bodies that approach each other.
struct Approach {
    double speed;    ///< their distance changes by at most this per unit of t
    double way;      ///< the longest of both, together
    double reach;    ///< the greatest coordinates of both at the start, together
    double size;     ///< of both together, for the default of the tolerance
    double bend = 0; ///< of both together (Motion::longest_bend)
};

/// A stretch of the way, from a time when the two are apart.
struct Stretch {
    double from, to;
    double reach;      ///< what is farther apart at the start does not come near
    double separation; ///< as near as this, all going straight, they may touch
    double tolerance;  ///< of the separation, relative to features
};

/// Until when nothing comes near in a stretch; if it is not its end, which parts then do.
struct FreeStretch {
    double until;
    Pair near{~0u, ~0u};
};

struct NoStretches {
    std::optional<FreeStretch> operator()(const Stretch&) const { return std::nullopt; }
};

inline void check(const ContinuousOptions& options) {
    if (!(options.tolerance >= 0))
        throw std::invalid_argument("a tolerance must be at least 0");
}

/// A stretch costs as much as many steps: the first is tried after so many, on end, that left more
/// than this part of the distance, and the next after twice as many if it was in vain.
inline constexpr int slow_steps = 16;
inline constexpr double slow_part = .98;

/// Conservative advancement. distance_at(t, options): the MeshDistance of the two at t. Its poses
/// may be rounded: by 2^-44 of the reach and the way together. free_in(stretch): the FreeStretch,
/// or nothing where that is too dear: steps of the least distance are short where bodies slide
/// along each other, or turn fast beside what they approach.
template <class DistanceAt, class FreeIn = NoStretches>
FirstContact advance(const Approach& approach, const ContinuousOptions& options,
                     const DistanceAt& distance_at, const FreeIn& free_in = {}) {
    FirstContact found;
    // What a pose may be off by moves corners by as much.
    const double rounding = 0x1p-44 * (approach.way + approach.reach);
    const double tolerance =
        std::max(options.tolerance > 0 ? options.tolerance : 0x1p-36 * approach.size, 4 * rounding);
    DistanceOptions near;
    double t = 0;
    double before = 0; // the distance of the step before
    int slow = 0;      // steps on end that hardly came nearer
    int wait = slow_steps;
    double steps_ahead = 16; // that a stretch spans
    while (found.steps < options.max_steps) {
        const MeshDistance d = distance_at(t, near);
        ++found.steps;
        if (d.lo <= tolerance && d.hi > tolerance && near.relative > 0) {
            near.relative = 0; // look again
            continue;
        }
        if (d.hi > tolerance && d.lo <= 2 * rounding && near.start) {
            near.start.reset(); // the bound of that pair may be a wide one: look without it
            continue;
        }
        if (d.hi <= tolerance || d.lo <= 2 * rounding) {
            found.hit = Answer::yes;
            found.t_free = found.t_hit = t;
            found.triangles = d.triangles;
            return found;
        }
        if (t >= 1)
            return found;
        // Nearer than the tolerance, so that the end is reached.
        const double free = std::max(d.lo - 2 * rounding, 0.0);
        const double step = approach.speed > 0 ? free / approach.speed * (1 - 0x1p-40) : 1;
        near.start = d.triangles;
        double next = std::min(1.0, t + step);
        slow = d.lo > slow_part * before ? slow + 1 : 0;
        before = d.lo;
        if (next < 1 && slow >= wait) {
            // No longer than what all bends in it leave sure.
            const double straight = approach.bend > 0 ? 2 * std::sqrt(free / approach.bend) : 1;
            const double h = std::min({1 - t, steps_ahead * step, straight});
            const double separation = approach.bend * h * h / 8 * (1 + 0x1p-40) + 4 * rounding;
            const Stretch stretch{t, std::min(1.0, t + h),
                                  approach.speed * h * (1 + 0x1p-40) + separation, separation,
                                  tolerance / (4 * approach.size)};
            if (h > 2 * step && separation < free) {
                const auto ahead = free_in(stretch);
                const bool is_far = ahead && ahead->until >= t + 4 * step;
                if (ahead) {
                    next = std::max(next, ahead->until);
                    if (ahead->near.a != ~0u)
                        near.start = ahead->near;
                }
                steps_ahead = !ahead                 ? std::max(steps_ahead / 4, 4.)
                              : ahead->near.a == ~0u ? 2 * steps_ahead
                                                     : steps_ahead;
                wait = is_far ? 2 : 2 * wait;
                slow = is_far ? slow : 0;
            }
        }
        found.t_free = t = next;
        // Far apart a rough distance will do.
        near.relative = d.lo > 64 * tolerance ? .1 : 0;
    }
    found.hit = Answer::maybe;
    found.t_free = t;
    return found;
}

} // namespace boxwood::detail
