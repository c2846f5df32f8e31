#pragma once

#include "bench/fuzz/fuzz.h"
#include "kernels/continuous/cubic.h"
#include "kernels/continuous/tight_inclusion.h"
#include "kernels/oracle/continuous.h"

#include <string>
#include <utility>

namespace boxwood::fuzz {

/// Eight points, as Coordinates has them; false if one is not finite.
inline bool read_motion(Bytes bytes, LinearMotion& motion, oracle::RationalMotion& exact) {
    Coordinates in(bytes);
    for (auto* points : {&motion.start, &motion.end})
        for (Vec3<double>& p : *points) {
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = in.next<double>();
            if (!is_finite(p))
                return false;
        }
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            exact.start[i][axis] = motion.start[i][static_cast<int>(axis)];
            exact.end[i][axis] = motion.end[i][static_cast<int>(axis)];
        }
    return true;
}

/// Not so many checks that a hard query takes seconds under the sanitizers.
inline TightInclusion fast_tight_inclusion() {
    TightInclusion kernel;
    kernel.max_checks = 2000;
    return kernel;
}

/// The never-miss kernel beside the truth: no touch missed, no time after the first touch free.
inline void judge(const Impact& impact, const Impact& truth) {
    require(impact.answer != Answer::no || truth.answer == Answer::no, "tight_inclusion misses");
    require(impact.answer != Answer::yes || truth.answer == Answer::yes,
            "tight_inclusion proves a touch that is none");
    if (truth.answer == Answer::yes)
        require(impact.t_free <= truth.t_hit && impact.t_hit >= truth.t_free,
                "tight_inclusion's times do not hold the first touch");
}

inline void require_same(const Impact& a, const Impact& b, const std::string& when) {
    require(a.answer == b.answer && a.t_free == b.t_free && a.t_hit == b.t_hit,
            "the exact answer is another " + when);
}

/// Corners i and k changed places.
inline oracle::RationalMotion swapped(oracle::RationalMotion motion, std::size_t i, std::size_t k) {
    std::swap(motion.start[i], motion.start[k]);
    std::swap(motion.end[i], motion.end[k]);
    return motion;
}

inline oracle::RationalMotion backward(const oracle::RationalMotion& motion) {
    return {motion.end, motion.start};
}

} // namespace boxwood::fuzz
