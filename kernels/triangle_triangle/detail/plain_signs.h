#pragma once

#include "kernels/triangle_triangle/detail/flat.h"

namespace boxwood::detail {

/// What Determinants<Real> says of a pair, one determinant at a time and without vectors of the
/// compiler: the same operations in the same order, so the same signs.
template <class R> class PlainSigns {
  public:
    using Real = R;
    using Vector = Vec3<Real>;

    BOXWOOD_BOTH PlainSigns(const Triangle<Real>& a, const Triangle<Real>& b)
        : p_{a.a, a.b, a.c, b.a, b.b, b.c}, normal_{cross(a.b - a.a, a.c - a.a),
                                                    cross(b.b - b.a, b.c - b.a)} {}

    BOXWOOD_BOTH Sides sides(int of) const {
        const Corner t = of == 0 ? 0 : 3, other = 3 - t;
        unsigned above = 0, below = 0, unknown = 0;
        for (Corner k = 0; k < 3; ++k) {
            const Real height = dot(p_[other + k] - p_[t], normal_[of]);
            above |= unsigned{height > 0} << k;
            below |= unsigned{height < 0} << k;
            unknown |= unsigned{height != height} << k;
        }
        return {above, below, unknown};
    }
    BOXWOOD_BOTH Sides decided_sides(int of) const { return sides(of); }

    BOXWOOD_BOTH Answer overlap_along_line(const Turned& a, const Turned& b) const {
        const Real low = along_line(a.q, a.p, b.p, b.q), high = along_line(a.p, a.r, b.p, b.r);
        return low > 0 || high > 0     ? Answer::no
               : low <= 0 && high <= 0 ? Answer::yes
                                       : Answer::maybe;
    }
    BOXWOOD_BOTH int orient3d(Corner a, Corner b, Corner c, Corner d) const {
        const Vector pa = p_[a];
        return sign(dot(p_[d] - pa, cross(p_[b] - pa, p_[c] - pa)));
    }
    BOXWOOD_BOTH int orient2d(int dropped, Corner a, Corner b, Corner c) const {
        const int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
        const Real pu = p_[a][u], pv = p_[a][v];
        return sign((p_[b][u] - pu) * (p_[c][v] - pv) - (p_[b][v] - pv) * (p_[c][u] - pu));
    }
    BOXWOOD_BOTH Answer overlap_in_plane(int dropped, int turn_a, int turn_b) const {
        const Real of_a = least_inside(dropped, 0, turn_a), of_b = least_inside(dropped, 3, turn_b);
        const Real worst = of_b < of_a ? of_b : of_a;
        return worst < 0 ? Answer::no : worst >= 0 ? Answer::yes : Answer::maybe;
    }
    BOXWOOD_BOTH Projection project(int of, Projection like) const {
        const Vector& n = normal_[of];
        if (like)
            if (const int t = sign(n[like.axis()]); t == 1 || t == -1)
                return {like.axis(), t};
        const int axis = largest_axis(n), t = sign(n[axis]);
        return t == undecided ? Projection::undecided() : Projection(axis, t);
    }
    BOXWOOD_BOTH Vector point(Corner k) const { return p_[k]; }

  private:
    BOXWOOD_BOTH static int sign(Real x) { return x == x ? int{x > 0} - int{x < 0} : undecided; }
    BOXWOOD_BOTH Real along_line(Corner a0, Corner a1, Corner b0, Corner b1) const {
        return dot(p_[b0] - p_[a0], cross(p_[a1] - p_[a0], p_[b1] - p_[b0]));
    }
    /// By edge of the triangle at t the other's corner that is farthest inside; the least of them.
    BOXWOOD_BOTH Real least_inside(int dropped, Corner t, int turned) const {
        const int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
        const auto turn = static_cast<Real>(turned);
        Real least = 0;
        for (Corner i = 0; i < 3; ++i) {
            const Vector p = p_[t + i], q = p_[t + (i + 1) % 3];
            const Real du = turn * (q[u] - p[u]), dv = turn * (q[v] - p[v]);
            Real farthest = 0;
            for (Corner j = 0; j < 3; ++j) {
                const Vector o = p_[3 - t + j];
                const Real inside = du * (o[v] - p[v]) - dv * (o[u] - p[u]);
                farthest = j == 0 || farthest < inside ? inside : farthest;
            }
            least = i == 0 || farthest < least ? farthest : least;
        }
        return least;
    }

    Vector p_[6], normal_[2];
};

} // namespace boxwood::detail
