#include "kernels/convex/detail/foot.h"

#include <algorithm>

namespace boxwood::convex::detail {
namespace {

using V = Vec3<double>;

/// The point x of the surface of an ellipsoid of radii a that is nearest to p: x_i = a_i t_i with
/// t_i = a_i p_i / d_i, d_i = a_i^2 + lambda, and t of unit length. lambda > -a_k^2 of the least
/// radius a_k; what is kept is lambda + a_k^2, with which the d_i do not cancel.
struct Multiplier {
    V a, p, ap{}, beyond{}; ///< beyond: a_i^2 - a_k^2
    int least = 0;
    double shift = 0;

    Multiplier(V point, V radii) : a(radii), p(point) {
        const double negligible = 0x1p-60 * std::max({a.x, a.y, a.z});
        for (int i = 0; i < 3; ++i)
            if (a[i] < negligible)
                a[i] = 0;
        for (int i = 1; i < 3; ++i)
            if (a[i] < a[least])
                least = i;
        for (int i = 0; i < 3; ++i) {
            ap[i] = a[i] * p[i];
            beyond[i] = (a[i] - a[least]) * (a[i] + a[least]);
        }
    }

    double divisor(int i) const { return beyond[i] + shift; }
    double lambda() const { return shift - a[least] * a[least]; }
    /// v_i / d_i; nothing over nothing is nothing.
    V divided(V v) const {
        V q{};
        for (int i = 0; i < 3; ++i)
            if (v[i] != 0 && divisor(i) > 0)
                q[i] = v[i] / divisor(i);
        return q;
    }

    /// Newton's method on 1 / |t| = 1, which is concave: from the left of the root, where one t_i
    /// is 1, each turn ends left of it. The form is that of Moré and Sorensen 1983, "Computing a
    /// trust region step". Without the term of the least radius the root is no further to the
    /// right; where that term is a spike, the step towards that root is the longer one.
    void solve() {
        constexpr int max_turns = 32;
        for (int i = 0; i < 3; ++i)
            shift = std::max(shift, std::abs(ap[i]) - beyond[i]);
        for (int turn = 0; turn < max_turns; ++turn) {
            const V t = divided(ap);
            double squared = 0, slope = 0;
            const auto add = [&](int i) {
                if (t[i] != 0)
                    squared += t[i] * t[i], slope += t[i] * t[i] / divisor(i);
            };
            const auto step = [&] { return squared / slope * (std::sqrt(squared) - 1); };
            add((least + 1) % 3), add((least + 2) % 3);
            const double others = step();
            add(least);
            const double next = std::max(step(), others);
            if (!(next > 2 * u * shift))
                return;
            shift += next;
        }
    }
};

bool is_inside(V p, V a) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        if (p[i] != 0)
            sum += (p[i] / a[i]) * (p[i] / a[i]);
    return sum < 1;
}

} // namespace

// Both ends are bounds for any multiplier, and meet at the root: the plane square to a direction
// below; above a point of the ellipsoid, or inside the Lagrange dual, lambda (sum p_i^2 / d_i - 1),
// which is at most the square of the distance to any point of the surface. Roundings: 12u below, 9u
// above outside, and 10u inside, where the dual's 9u |lambda| is divided by twice its root, which
// is at least |lambda| over the greatest radius.
Foot foot(V p, const Ellipsoid& s) {
    Multiplier m(p, s.radii);
    m.solve();
    V t = m.divided(m.ap), normal = m.divided(p), up{};
    const int k = m.least;
    up[k] = std::copysign(1.0, p[k]);
    if (!(m.shift > 0)) { // p lies in the plane square to the least radius, near its middle
        t[k] = std::copysign(std::sqrt(std::max(1 - dot(t, t), 0.0)), p[k]);
        normal = normal * m.a[k];
        normal[k] = t[k];
    }
    t = unit_or(t, up);
    const V on{m.a.x * t.x, m.a.y * t.y, m.a.z * t.z}, away = p - on;
    const auto gap_along = [&](V n) {
        return dot(n, p) - length(V{m.a.x * n.x, m.a.y * n.y, m.a.z * n.z});
    };
    Foot f{0, on, unit_or(normal, up)};
    double lo = gap_along(f.normal), hi = length(away);
    if (is_inside(p, m.a)) {
        const V q = m.divided(p);
        hi = -std::sqrt(std::max(m.lambda() * (dot(p, q) - 1), 0.0));
    } else {
        const V n = unit_or(away, f.normal);
        if (const double gap = gap_along(n); gap > lo)
            lo = gap, f.normal = n;
    }
    f.distance = hi;
    f.width = std::max(hi - lo, 0.0);
    return f;
}

} // namespace boxwood::convex::detail
