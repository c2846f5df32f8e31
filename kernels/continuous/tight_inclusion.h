#pragma once

#include "kernels/continuous/continuous_kernel.h"

#include <cstddef>
#include <limits>

namespace boxwood {

/// Tight inclusion: patches of (u, v) are searched, earliest time first. For each a direction is
/// guessed that separates it from the origin, and the time until which it does so is bounded with
/// the rounding taken off; a patch whose bound is poor is halved. So no touch is missed at any
/// scale, and even a `yes` is proven (Poincare-Miranda). `maybe`: nearer than the tolerance, or
/// than rounding can decide, at t_free; then t_hit is 1. NaN or infinity: maybe.
/// False alarms, of the 7,279 queries of the Erleben and unit test scenes published with that
/// paper: 161. 155 of them miss by at most 1.4e-16 of their size, which no rounding of doubles can
/// tell from a touch; 6 by less than the tolerance. No smaller tolerance helps the 155; `exact` has
/// none. Tier 0: the boxes of the motions are apart. 1: no patch was halved. 2: some were. 3: a
/// limit. Source: Wang et al. 2021 (inclusion function, tolerance); time is cut by separating
/// planes, as in conservative advancement, where they halve it.
struct TightInclusion {
    static constexpr std::string_view name = "tight_inclusion";
    static constexpr KernelInfo vertex_face_info{
        "vertex_face",
        name,
        "inclusion function over (t, u, v), time cut by separating planes (after Wang 2021)",
        Promise::never_miss,
        "36 u max|x| per axis on F, homogeneous of degree 1 (inclusion.h); a yes is proven, else "
        "maybe",
        "boxes of the motion, then about 100 ns per plane; 5 to 10 as a rule, 50 for a grazing "
        "touch; 161 false alarms on 7,279 published queries, 155 of them misses by rounding",
        0,
        true};
    static constexpr KernelInfo edge_edge_info{"edge_edge",
                                               name,
                                               vertex_face_info.summary,
                                               vertex_face_info.promise,
                                               vertex_face_info.bound,
                                               vertex_face_info.cost,
                                               0,
                                               true};

    /// Relative: times the largest distance, along an axis, between a point of the one feature and
    /// one of the other during the motion. What is nearer than that is not halved further. Smaller
    /// means fewer maybes and a later t_free; 0 means as far as rounding can decide.
    double tolerance = 1e-6;
    /// Scene units: what comes at most this near counts as a touch. Then no yes is proven, maybe is
    /// the most that is said, and before t_free they are farther from each other than this.
    double separation = 0;
    /// Planes tried at most; after that maybe, with the time reached as t_free.
    std::size_t max_checks = 100'000;
    /// Seconds at most, looked at every 64 planes; answers then depend on the machine.
    double time_limit_s = std::numeric_limits<double>::infinity();

    Impact vertex_face(const LinearMotion& motion) const;
    Impact edge_edge(const LinearMotion& motion) const;
};

} // namespace boxwood
