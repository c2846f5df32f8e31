#pragma once

#include "kernels/predicates/filtered.h"
#include "kernels/triangle_triangle/flat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace boxwood {

/// Two numbers in one register, and the same number of bits for what comparisons answer.
template <class Real> struct TwoOf;
template <> struct TwoOf<double> {
    using Bit = std::int64_t;
    using Values [[gnu::vector_size(16)]] = double;
    using Bits [[gnu::vector_size(16)]] = Bit;
};
template <> struct TwoOf<float> {
    using Bit = std::int32_t;
    using Values [[gnu::vector_size(8)]] = float;
    using Bits [[gnu::vector_size(8)]] = Bit;
};

/// The signs of a pair by determinants in plain Real arithmetic, normals shared, two at a time, no
/// branch on a sign. With `filtered` (double only), just those that the error bound of
/// predicates/filtered.h lets stand, S taken from the triangles' extents: a triple product has a
/// factor of each axis, and rounding is monotone, so that no computed difference exceeds its
/// computed extent.
template <class R, bool filtered = false> class Determinants {
    static_assert(!filtered || std::is_same_v<R, double>);

  public:
    using Real = R;

    Determinants(const Triangle<Real>& a, const Triangle<Real>& b)
        : p_{&a.a, &a.b, &a.c, &b.a, &b.b, &b.c} {
        const Points corner[3] = {points(0, 3), points(1, 4), points(2, 5)};
        const Points base = swapped(corner[0]);
        const Points n = swapped(cross(corner[1] - corner[0], corner[2] - corner[0]));
        Two error{};
        if constexpr (filtered)
            error = set_extents(corner);
        for (std::size_t k = 0; k < 3; ++k) {
            // First a's corner to b's plane, second b's to a's.
            const Two det = dot(corner[k] - base, n);
            const Bits bit = Bits{} + (Bit{1} << k);
            above_ |= (det > error) & bit;
            below_ |= (det < -error) & bit;
            if constexpr (!filtered)
                known_ |= (det == det) & bit;
        }
    }

    Sides sides(int of) const {
        const auto bits = [of](const Bits& b) { return static_cast<unsigned>(b[of == 0 ? 1 : 0]); };
        const unsigned above = bits(above_), below = bits(below_);
        return {above, below, 7 & ~(filtered ? above | below : bits(known_))};
    }

    Sides decided_sides(int of) const { return sides(of); }

    /// The normals here are those of an edge of each triangle.
    Answer overlap_along_line(const Turned& a, const Turned& b) const {
        const Points a0 = points(a.q, a.p), a1 = points(a.p, a.r);
        const Points b0 = points(b.p, b.p), b1 = points(b.q, b.r);
        const Two det = dot(b0 - a0, cross(a1 - a0, b1 - b0));
        const Real error = error3d();
        const Bits apart = det > error, meet = filtered ? det < -error : det <= error;
        return (apart[0] | apart[1]) != 0 ? Answer::no
               : (meet[0] & meet[1]) != 0 ? Answer::yes
                                          : Answer::maybe;
    }

    int orient3d(Corner a, Corner b, Corner c, Corner d) const {
        const Vec3<Real> pa = *p_[a];
        return sign(dot(*p_[d] - pa, cross(*p_[b] - pa, *p_[c] - pa)), error3d());
    }

    int orient2d(int dropped, Corner a, Corner b, Corner c) {
        return known(judged2d(dropped, a, b, c));
    }
    /// The same, with `undecided` handed on.
    int judged2d(int dropped, Corner a, Corner b, Corner c) const {
        const int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
        const Vec3<Real>&p = *p_[a], &q = *p_[b], &r = *p_[c];
        return sign((q[u] - p[u]) * (r[v] - p[v]) - (q[v] - p[v]) * (r[u] - p[u]), error2d(u, v));
    }

    /// The edges of both triangles at a time, the other's corners against each.
    Answer overlap_in_plane(int dropped, int turn_a, int turn_b) const {
        constexpr Real Vec3<Real>::*axes[] = {&Vec3<Real>::x, &Vec3<Real>::y, &Vec3<Real>::z,
                                              &Vec3<Real>::x, &Vec3<Real>::y};
        Two u[3], v[3];
        for (Corner k = 0; k < 3; ++k) {
            u[k] = Two{p_[k]->*axes[dropped + 1], p_[k + 3]->*axes[dropped + 1]};
            v[k] = Two{p_[k]->*axes[dropped + 2], p_[k + 3]->*axes[dropped + 2]};
        }
        const Two turn{static_cast<Real>(turn_a), static_cast<Real>(turn_b)};
        const Real error = error2d((dropped + 1) % 3, (dropped + 2) % 3);
        Bits parted{}, together = ~parted;
        for (Corner i = 0; i < 3; ++i) {
            const Two du = turn * (u[(i + 1) % 3] - u[i]), dv = turn * (v[(i + 1) % 3] - v[i]);
            Bits outside = ~Bits{}, inside{};
            for (Corner j = 0; j < 3; ++j) {
                const Two det = du * (swapped(v[j]) - v[i]) - dv * (swapped(u[j]) - u[i]);
                outside &= det < -error;
                inside |= filtered ? det > error : det >= error;
            }
            parted |= outside;
            together &= inside;
        }
        return (parted[0] | parted[1]) != 0       ? Answer::no
               : (together[0] & together[1]) != 0 ? Answer::yes
                                                  : Answer::maybe;
    }

    /// The largest component of the normal is the surest.
    Projection project(int of, int preferred) {
        const Corner t = of == 0 ? 0 : 3;
        const Vec3<Real> n = cross(*p_[t + 1] - *p_[t], *p_[t + 2] - *p_[t]);
        const auto turn = [&](int axis) {
            return sign(n[axis], error2d((axis + 1) % 3, (axis + 2) % 3));
        };
        if (preferred != Projection::none) {
            const int known_turn = turn(preferred);
            if (known_turn == 1 || known_turn == -1)
                return {preferred, known_turn};
        }
        const int axis = largest_axis(n), known_turn = known(turn(axis));
        return known_turn == 0 ? Projection{} : Projection{axis, known_turn};
    }

    Vec3<Real> point(Corner k) const { return *p_[k]; }
    bool unsure() const { return unsure_; }
    /// Whether the extent of both along an axis is zero, or was flushed to zero.
    bool seems_flat(int axis) const { return extent_[axis] == 0; }

  private:
    using Two = typename TwoOf<Real>::Values;
    using Bits = typename TwoOf<Real>::Bits;
    using Bit = typename TwoOf<Real>::Bit;
    using Points = Vec3<Two>;

    Points points(Corner a, Corner b) const {
        return {Two{p_[a]->x, p_[b]->x}, Two{p_[a]->y, p_[b]->y}, Two{p_[a]->z, p_[b]->z}};
    }
    static Two swapped(const Two& v) { return __builtin_shufflevector(v, v, 1, 0); }
    static Points swapped(const Points& p) { return {swapped(p.x), swapped(p.y), swapped(p.z)}; }

    /// The errors of sides(1) and sides(0).
    Two set_extents(const Points (&corner)[3]) {
        const Points low = min(min(corner[0], corner[1]), corner[2]);
        const Points high = max(max(corner[0], corner[1]), corner[2]);
        const Points t = swapped(high - low);
        const Points both = max(high, swapped(high)) - min(low, swapped(low));
        extent_ = {both.x[0], both.y[0], both.z[0]};
        const Real most = std::max(std::max(extent_.x, extent_.y), extent_.z);
        // Beyond `largest`, and with an infinity among the extents, no error stands (it is infinite
        // or NaN); NaN makes its determinants NaN.
        scale_ = most < filter_bound::largest ? 2 : std::numeric_limits<Real>::infinity();
        const Two half = t.x * t.y * both.z + t.y * t.z * both.x + t.z * t.x * both.y;
        return scale_ * filter_bound::orient3d * half + filter_bound::flushing;
    }
    Real error3d() const {
        if constexpr (filtered)
            return 3 * scale_ * filter_bound::orient3d * (extent_.x * extent_.y * extent_.z) +
                   filter_bound::flushing;
        return 0;
    }
    Real error2d(int u, int v) const {
        if constexpr (filtered)
            return scale_ * filter_bound::orient2d * extent_[u] * extent_[v] +
                   filter_bound::flushing;
        return 0;
    }

    static int sign(Real det, Real error) {
        if (filtered)
            return det > error ? 1 : det < -error ? -1 : undecided;
        return det == det ? int{det > 0} - int{det < 0} : undecided;
    }
    int known(int sign) {
        unsure_ |= sign == undecided;
        return sign == undecided ? 0 : sign;
    }

    std::array<const Vec3<Real>*, 6> p_;
    Bits above_{}, below_{}, known_{};
    Vec3<Real> extent_;
    Real scale_ = 2;
    bool unsure_ = false;
};

using FilteredPair = Determinants<double, true>;

} // namespace boxwood
