// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/world/detail/obb_fit.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "kernels/arithmetic/rounding.h"
#include "trees/world/detail/obb_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, 16> df;
using V = hn::Vec<decltype(df)>;

/// One rotation in the plane of axes p and q, r the third: clears a_pq. v: the axes so far.
HWY_INLINE void rotate(V& app, V& aqq, V& apq, V& apr, V& aqr, V (&vp)[3], V (&vq)[3]) {
    const V tiny = hn::Set(df, 1e-30f), one = hn::Set(df, 1.0f);
    // tan of the angle, the smaller root of t^2 + 2 theta t - 1 = 0; 0 where there is nothing to
    // do.
    const V twice = hn::Add(apq, apq);
    const auto idle = hn::Lt(hn::Abs(apq), tiny);
    const V theta = hn::Div(hn::Sub(aqq, app), hn::IfThenElse(idle, one, twice));
    const V root = hn::Sqrt(hn::Add(hn::Mul(theta, theta), one));
    const V size = hn::Div(one, hn::Add(hn::Abs(theta), root));
    const V t = hn::IfThenZeroElse(idle, hn::CopySign(size, theta));
    const V c = hn::Div(one, hn::Sqrt(hn::Add(hn::Mul(t, t), one))), s = hn::Mul(t, c);
    const V change = hn::Mul(t, apq);
    app = hn::Sub(app, change);
    aqq = hn::Add(aqq, change);
    apq = hn::Zero(df);
    const auto turn = [&](V& p, V& q) HWY_ATTR {
        const V old = p;
        p = hn::Sub(hn::Mul(c, old), hn::Mul(s, q));
        q = hn::Add(hn::Mul(s, old), hn::Mul(c, q));
    };
    turn(apr, aqr);
    for (int k = 0; k < 3; ++k)
        turn(vp[k], vq[k]);
}

void axes_of(const SymmetricRows& m, std::size_t n, float* const (&axes)[9]) {
    for (std::size_t i = 0; i < n; i += hn::Lanes(df)) {
        const auto row = [&](std::size_t k) HWY_ATTR { return hn::LoadU(df, m.of[k] + i); };
        V xx = row(0), xy = row(1), xz = row(2), yy = row(3), yz = row(4), zz = row(5);
        const V one = hn::Set(df, 1.0f), zero = hn::Zero(df);
        V x[3] = {one, zero, zero}, y[3] = {zero, one, zero}, z[3] = {zero, zero, one};
        for (int sweep = 0; sweep < 5; ++sweep) {
            rotate(xx, yy, xy, xz, yz, x, y);
            rotate(xx, zz, xz, xy, yz, x, z);
            rotate(yy, zz, yz, xy, xz, y, z);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            hn::StoreU(x[k], df, axes[k] + i);
            hn::StoreU(y[k], df, axes[3 + k] + i);
            hn::StoreU(z[k], df, axes[6 + k] + i);
        }
    }
}

/// The integral of x x^T over a triangle is area / 12 (s s^T + a a^T + b b^T + c c^T), s = a + b +
/// c.
void moments_about(const float (&origin)[3], float scale, const CornerRows& corners,
                   std::size_t first, std::size_t n, Moments& sums) {
    const hn::CappedTag<float, 8> d;
    using Lanes = hn::Vec<decltype(d)>;
    const Lanes zero = hn::Zero(d), size = hn::Set(d, scale);
    Lanes sum[10];
    for (Lanes& s : sum)
        s = zero;
    for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
        const auto used = hn::FirstN(d, n - i);
        Lanes p[3][3], s[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Lanes from = hn::Set(d, origin[axis]);
            for (std::size_t corner = 0; corner < 3; ++corner)
                p[corner][axis] = hn::Mul(
                    hn::Sub(hn::LoadU(d, corners.of[corner][axis] + first + i), from), size);
            s[axis] = hn::Add(hn::Add(p[0][axis], p[1][axis]), p[2][axis]);
        }
        Lanes squared = zero;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
            const Lanes c = hn::Sub(hn::Mul(hn::Sub(p[1][y], p[0][y]), hn::Sub(p[2][z], p[0][z])),
                                    hn::Mul(hn::Sub(p[1][z], p[0][z]), hn::Sub(p[2][y], p[0][y])));
            squared = hn::MulAdd(c, c, squared);
        }
        const Lanes area = hn::IfThenElseZero(used, hn::Mul(hn::Sqrt(squared), hn::Set(d, 0.5f)));
        const Lanes third = hn::Mul(area, hn::Set(d, 1.0f / 3)),
                    twelfth = hn::Mul(area, hn::Set(d, 1.0f / 12));
        sum[0] = hn::Add(sum[0], area);
        std::size_t at = 4;
        for (std::size_t j = 0; j < 3; ++j) {
            sum[1 + j] = hn::MulAdd(third, s[j], sum[1 + j]);
            for (std::size_t k = j; k < 3; ++k, ++at) {
                Lanes product = hn::Mul(s[j], s[k]);
                for (std::size_t corner = 0; corner < 3; ++corner)
                    product = hn::MulAdd(p[corner][j], p[corner][k], product);
                sum[at] = hn::MulAdd(twelfth, product, sum[at]);
            }
        }
    }
    double total[10];
    for (std::size_t k = 0; k < 10; ++k)
        total[k] = double{hn::GetLane(hn::SumOfLanes(d, sum[k]))};
    sums.area = total[0];
    std::copy(total + 1, total + 4, sums.first);
    std::copy(total + 4, total + 10, sums.second);
}

/// The least and greatest of axis . (corner - centre) over the corners [first, last), by axis.
void extents_of(const float (&axes)[9], const float (&centre)[3], const CornerRows& corners,
                std::size_t first, std::size_t last, float (&least)[3], float (&greatest)[3]) {
    const hn::CappedTag<float, 8> d;
    using Lanes = hn::Vec<decltype(d)>;
    const float infinity = std::numeric_limits<float>::infinity();
    Lanes low[3], high[3], n[9];
    for (int k = 0; k < 3; ++k) {
        low[k] = hn::Set(d, infinity);
        high[k] = hn::Set(d, -infinity);
    }
    for (std::size_t k = 0; k < 9; ++k)
        n[k] = hn::Set(d, axes[k]);
    const Lanes cx = hn::Set(d, centre[0]), cy = hn::Set(d, centre[1]), cz = hn::Set(d, centre[2]);
    for (std::size_t i = first; i < last; i += hn::Lanes(d)) {
        const auto in_range = hn::FirstN(d, last - i);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Lanes x = hn::Sub(hn::LoadU(d, corners.of[corner][0] + i), cx);
            const Lanes y = hn::Sub(hn::LoadU(d, corners.of[corner][1] + i), cy);
            const Lanes z = hn::Sub(hn::LoadU(d, corners.of[corner][2] + i), cz);
            for (std::size_t k = 0; k < 3; ++k) {
                const Lanes along = hn::Add(hn::Add(hn::Mul(n[3 * k], x), hn::Mul(n[3 * k + 1], y)),
                                            hn::Mul(n[3 * k + 2], z));
                low[k] = hn::Min(low[k], hn::IfThenElse(in_range, along, low[k]));
                high[k] = hn::Max(high[k], hn::IfThenElse(in_range, along, high[k]));
            }
        }
    }
    for (int k = 0; k < 3; ++k) {
        least[k] = hn::GetLane(hn::MinOfLanes(d, low[k]));
        greatest[k] = hn::GetLane(hn::MaxOfLanes(d, high[k]));
    }
}

float farthest_squared(const float (&centre)[3], const CornerRows& corners, std::size_t n) {
    const hn::CappedTag<float, 8> d;
    const auto cx = hn::Set(d, centre[0]), cy = hn::Set(d, centre[1]), cz = hn::Set(d, centre[2]);
    auto farthest = hn::Zero(d);
    for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
        const auto in_range = hn::FirstN(d, n - i);
        for (const auto& corner : corners.of) {
            const auto x = hn::Sub(hn::LoadU(d, corner[0] + i), cx);
            const auto y = hn::Sub(hn::LoadU(d, corner[1] + i), cy);
            const auto z = hn::Sub(hn::LoadU(d, corner[2] + i), cz);
            const auto squared = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
            farthest = hn::Max(farthest, hn::IfThenElseZero(in_range, squared));
        }
    }
    return hn::GetLane(hn::MaxOfLanes(d, farthest));
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(axes_of);
HWY_EXPORT(extents_of);
HWY_EXPORT(moments_about);
HWY_EXPORT(farthest_squared);

double farthest_from(const float (&centre)[3], const CornerRows& corners, std::size_t n) {
    const float squared = HWY_DYNAMIC_DISPATCH(farthest_squared)(centre, corners, n);
    // Six roundings of up to 2^-24, and squares that underflow.
    return std::sqrt(double{squared}) * (1 + 0x1p-21) + 0x1p-61;
}

void principal_axes(const SymmetricRows& matrices, std::size_t n, float* const (&axes)[9]) {
    HWY_DYNAMIC_DISPATCH(axes_of)(matrices, n, axes);
}

Moments moments_of(const CornerRows& corners, std::size_t first, std::size_t n,
                   const Vec3<double>& centre, double scale) {
    float origin[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        origin[axis] = corners.of[0][axis][first];
    Moments m;
    HWY_DYNAMIC_DISPATCH(moments_about)
    (origin, static_cast<float>(scale), corners, first, n, m);
    // Seen from the centre: every point moves by the same.
    double by[3];
    for (std::size_t k = 0; k < 3; ++k)
        by[k] = (double{origin[k]} - centre[static_cast<int>(k)]) * scale;
    std::size_t at = 0;
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t k = j; k < 3; ++k, ++at)
            m.second[at] += m.first[j] * by[k] + by[j] * m.first[k] + m.area * by[j] * by[k];
    for (std::size_t k = 0; k < 3; ++k)
        m.first[k] += m.area * by[k];
    return m;
}

PosedBox box_of(const Aabb<float>& bounds) {
    PosedBox box{};
    for (int k = 0; k < 3; ++k) {
        const double low = double{bounds.min[k]}, high = double{bounds.max[k]};
        box.centre[k] = (low + high) / 2;
        // The centre may be rounded, if the two are 2^29 apart: both sides count.
        box.half[k] = round_up(std::max(high - box.centre[k], box.centre[k] - low));
        box.axis[k][k] = 1;
    }
    return box;
}

// A projection along an axis n, seen from a float centre c within the bounds: |x - c|_1 <= size,
// the sum of the bounds' sides. x - c has 1 rounding, a product 1, the sums 2: 4u |x - c|_1, u =
// 2^-24. The true centre is c + sum mid_k axis_k, which moves the projections on axis k by mid_k
// and by sum_j mid_j (axis_k . axis_j - [k = j]), at most 3.5u * 3 |mid| <= 11u size. In all below
// 16u size = 2^-20 size; 2^-19 leaves room for what is rounded in doubles and for the sum itself.
PosedBox box_along(const float (&axes)[9], const CornerRows& corners, std::size_t first,
                   std::size_t last, const Aabb<float>& bounds) {
    PosedBox box{};
    // Orthonormal in doubles, then rounded: |axis_i . axis_j - [i = j]| <= 3.5u.
    Vec3<double> n[3];
    for (std::size_t k = 0; k < 3; ++k)
        n[k] = {double{axes[3 * k]}, double{axes[3 * k + 1]}, double{axes[3 * k + 2]}};
    n[0] = (1 / length(n[0])) * n[0];
    n[1] = n[1] - dot(n[1], n[0]) * n[0];
    n[1] = (1 / length(n[1])) * n[1];
    n[2] = cross(n[0], n[1]);
    float rows[9];
    for (int k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis) {
            const float rounded = static_cast<float>(n[k][axis]);
            rows[3 * k + axis] = box.axis[k][axis] = rounded;
            n[k][axis] = double{rounded};
        }
    const PosedBox around = box_of(bounds);
    const float centre[3] = {static_cast<float>(around.centre[0]),
                             static_cast<float>(around.centre[1]),
                             static_cast<float>(around.centre[2])};
    const double size =
        2.001 * (double{around.half[0]} + double{around.half[1]} + double{around.half[2]});
    float least[3], greatest[3];
    HWY_DYNAMIC_DISPATCH(extents_of)(rows, centre, corners, first, last, least, greatest);
    Vec3<double> middle{double{centre[0]}, double{centre[1]}, double{centre[2]}};
    double skew = 0, halves = 0;
    for (int k = 0; k < 3; ++k) {
        const double mid = (double{least[k]} + double{greatest[k]}) / 2;
        middle = middle + mid * n[k];
        const double half = std::max(double{greatest[k]} - mid, mid - double{least[k]});
        box.half[k] = round_up(half + 0x1p-19 * size);
        halves += double{box.half[k]};
        for (int j = 0; j <= k; ++j)
            skew = std::max(skew, std::abs(dot(n[k], n[j]) - (j == k ? 1 : 0)));
    }
    for (int k = 0; k < 3; ++k)
        box.centre[k] = middle[k];
    // y = N (x - centre) with |y_k| <= half_k; x - centre = N^-1 y, and along a unit vector N^-1
    // differs from N^T by less than 2 max |N N^T - 1| sum |y_k|.
    box.slack = round_up(2 * (skew + 0x1p-50) * halves);
    return box;
}

} // namespace boxwood::detail
#endif
