#pragma once

#include "kernels/continuous/detail/inclusion.h"
#include "kernels/continuous/detail/nearest_direction.h"

#include <optional>

namespace boxwood::detail::inclusion {

struct Parameters {
    double t, u, v;
};

/// A time at or before which F has a zero for certain, if one is found near the guess.
///
/// Poincare-Miranda: if on a box the function d_k.F is negative all over the lower face of axis k
/// and positive all over the upper one, k = t, u, v, all three vanish together somewhere in it. On
/// a face d_k.F is linear in each parameter, so its corners decide. The d_k are independent, so F
/// is 0 there: if sum l_k d_k = 0, then sum l_k d_k.F = 0 everywhere, also at the corner of the box
/// where every term is positive.
template <int n> std::optional<double> proven_touch(const Inclusion<n>& f, Parameters at) {
    using Vector = Vec3<double>;
    Vector by_t, by_u, by_v, rows[3];
    for (int step = 0; step < 4; ++step) { // Newton's; the last one only sets the rows
        by_t = f.end.at(at.u, at.v) - f.start.at(at.u, at.v);
        by_u = mean(f.start.b, f.end.b, at.t);
        by_v = mean(f.start.c, f.end.c, at.t);
        rows[0] = cross(by_u, by_v);
        rows[1] = cross(by_v, by_t);
        rows[2] = cross(by_t, by_u);
        const double det = dot(by_t, rows[0]);
        if (!(std::abs(det) > 0))
            return std::nullopt;
        if (step == 3)
            break;
        const Vector value = mean(f.start.at(at.u, at.v), f.end.at(at.u, at.v), at.t);
        at.t -= dot(rows[0], value) / det;
        at.u -= dot(rows[1], value) / det;
        at.v -= dot(rows[2], value) / det;
    }

    const Vector columns[3] = {by_t, by_u, by_v};
    const double centre[3] = {at.t, at.u, at.v};
    double margin[3], slope[3];
    for (int k = 0; k < 3; ++k) {
        rows[k] = normalised(rows[k]);
        slope[k] = dot(rows[k], columns[k]);
        if (slope[k] < 0)
            rows[k] = -rows[k];
        margin[k] = f.margin(rows[k]);
    }
    // Small boxes first, for their early end; larger ones carry further over the rounding.
    for (const double size : {4.0, 32.0, 0x1p12}) {
        double low[3], high[3];
        for (int k = 0; k < 3; ++k) {
            const double half = size * (margin[k] / std::abs(slope[k]) + 0x1p-53);
            low[k] = centre[k] - half;
            high[k] = centre[k] + half;
        }
        const bool inside = low[0] >= 0 && high[0] <= 1 && low[1] >= 0 && low[2] >= 0 &&
                            (n == 3 ? high[1] + high[2] < 1 : high[1] <= 1 && high[2] <= 1);
        if (!inside)
            return std::nullopt;
        bool proven = true;
        for (int corner = 0; corner < 8 && proven; ++corner) {
            const auto end = [&](int k) { return (corner >> k & 1) != 0 ? high[k] : low[k]; };
            const double t = end(0), u = end(1), v = end(2);
            const Vector start = f.start.at(u, v), stop = f.end.at(u, v);
            for (int k = 0; k < 3; ++k) {
                const double value = mean(dot(rows[k], start), dot(rows[k], stop), t);
                proven =
                    proven && ((corner >> k & 1) != 0 ? value > margin[k] : value < -margin[k]);
            }
        }
        if (proven)
            return high[0];
    }
    return std::nullopt;
}

} // namespace boxwood::detail::inclusion
