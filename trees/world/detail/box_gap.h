#pragma once

#include "trees/world/detail/pair_frame.h"

namespace boxwood::detail {

/// A box in doubles, exactly as it is stored.
struct BoxF64 {
    explicit BoxF64(const PosedBox& box)
        : centre{box.centre[0], box.centre[1], box.centre[2]}, slack(double{box.slack}) {
        for (int k = 0; k < 3; ++k) {
            axis[k] = {double{box.axis[k][0]}, double{box.axis[k][1]}, double{box.axis[k][2]}};
            half[k] = double{box.half[k]};
        }
    }
    BoxF64(const ObbBlock& block, std::size_t lane)
        : centre{block.centre_f64[0][lane], block.centre_f64[1][lane], block.centre_f64[2][lane]},
          slack(double{block.slack[lane]}) {
        for (std::size_t k = 0; k < 3; ++k) {
            axis[k] = {double{block.axis[k][0][lane]}, double{block.axis[k][1][lane]},
                       double{block.axis[k][2][lane]}};
            half[k] = double{block.half[k][lane]};
        }
    }

    Vec3<double> centre, axis[3];
    double half[3], slack;
};

/// A bound from below of the distance of a box of A and one of B: the greatest gap along their six
/// axes, computed in doubles. It tells ties apart that floats cannot: flat faces that are parallel
/// are at their distance exactly. Along its own axes a box reaches half_k, as it is defined; along
/// others what PosedBox::slack says. Off by less than 2^-46 of |t| and the halves, and `turned`.
inline double box_gap(const BoxF64& a, const BoxF64& b, const PairFrame& frame) {
    const Vec3<double> t = frame.pose(b.centre) - a.centre;
    Vec3<double> turned[3];
    const auto& r = frame.pose.rotation;
    for (int j = 0; j < 3; ++j)
        turned[j] = {dot(r[0], b.axis[j]), dot(r[1], b.axis[j]), dot(r[2], b.axis[j])};
    double sum_a[3], sum_b[3], size = std::abs(t.x) + std::abs(t.y) + std::abs(t.z);
    for (int k = 0; k < 3; ++k) {
        sum_a[k] = a.half[k] + b.slack;
        sum_b[k] = b.half[k] + a.slack;
        size += a.half[k] + b.half[k];
    }
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) {
            const double cosine = std::abs(dot(a.axis[k], turned[j]));
            sum_a[k] += cosine * b.half[j];
            sum_b[j] += cosine * a.half[k];
        }
    double gap = 0;
    for (int k = 0; k < 3; ++k) {
        const double along_a = std::abs(dot(a.axis[k], t)) - sum_a[k];
        const double along_b = std::abs(dot(turned[k], t)) - sum_b[k];
        if (along_a > 0)
            gap = std::max(gap, along_a / length(a.axis[k]));
        if (along_b > 0)
            gap = std::max(gap, along_b / length(b.axis[k]));
    }
    return gap - (0x1p-46 * size + frame.turned);
}

} // namespace boxwood::detail
