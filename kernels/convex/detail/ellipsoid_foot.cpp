#include "kernels/convex/detail/ellipsoid_foot.h"

#include <algorithm>

namespace boxwood::convex::detail {

using V = Vec3<double>;

EllipsoidFoot::EllipsoidFoot(V p, V a) : radii(a), point(p) {
    const double most = std::max({a.x, a.y, a.z});
    for (int i = 0; i < 3; ++i) {
        if (radii[i] < 0x1p-60 * most)
            radii[i] = 0;
        if (radii[i] < radii[least])
            least = i;
    }
    for (int i = 0; i < 3; ++i) {
        products[i] = radii[i] * point[i];
        if (radii[i] > 0 && std::abs(products[i]) < 0x1p-700 * most * most)
            point[i] = products[i] = 0;
        beyond[i] = (radii[i] - radii[least]) * (radii[i] + radii[least]);
    }
    for (int i = 0; i < 3; ++i)
        shift = std::max(shift, std::abs(products[i]) - beyond[i]);
}

/// v_i / d_i; nothing over nothing is nothing.
V EllipsoidFoot::divided(V v) const {
    V q{};
    for (int i = 0; i < 3; ++i)
        if (v[i] != 0 && divisor(i) > 0)
            q[i] = v[i] / divisor(i);
    return q;
}

/// Newton's method on 1 / |t| = 1, which is concave: from the left of the root each turn ends left
/// of it. The form is that of Moré and Sorensen 1983, "Computing a trust region step". Without the
/// term of the least radius the root is no further to the right; where that term is a spike, the
/// step towards that root is the longer one. Slowest is a spike whose root is far: where its term
/// is all of |t|^2 - 1 and of the slope, a step is half the shift, and the term, a square over the
/// shift's, shrinks by 2.25 a turn; in 45 turns from 1 to rounding.
void EllipsoidFoot::solve() {
    constexpr int max_turns = 64;
    for (int turn = 0; turn < max_turns; ++turn) {
        const V t = divided(products);
        double squared = 0, slope = 0;
        const auto add = [&](int i) {
            if (t[i] != 0)
                squared += t[i] * t[i], slope += t[i] * t[i] / divisor(i);
        };
        const auto step = [&] { return squared / slope * (std::sqrt(squared) - 1); };
        add((least + 1) % 3), add((least + 2) % 3);
        const double others = step();
        add(least);
        const double next = std::max(step(), others); // the first if the other is 0 / 0
        if (!(next > 2 * u * shift))
            return;
        shift += next;
    }
}

bool EllipsoidFoot::is_inside() const {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        if (point[i] != 0)
            sum += (point[i] / radii[i]) * (point[i] / radii[i]);
    return sum < 1;
}

/// From below, the plane square to a direction. From above, a point of the ellipsoid; inside, the
/// Lagrange dual, lambda (sum p_i^2 / d_i - 1), which is at most the square of the distance to any
/// point of the surface. Roundings: 12u below, 9u above outside, 10u inside: of the dual they are
/// 9u |lambda|, which its root divides by 2 sqrt(dual). At the multiplier l of the root that is at
/// least 2 |l| over the greatest radius A; elsewhere 9u |lambda - l| is more than what the dual,
/// concave, falls by, (lambda - l)^2 / A^2, by at most (4.5u A)^2.
Foot EllipsoidFoot::foot() const {
    V t = divided(products), normal = divided(point), up{};
    up[least] = std::copysign(1.0, point[least]);
    if (!(shift > 0)) { // the point lies in the plane square to the least radius, near its middle
        t[least] = std::copysign(std::sqrt(std::max(1 - dot(t, t), 0.0)), point[least]);
        normal = normal * radii[least];
        normal[least] = t[least];
    }
    const auto stretched = [&](V v) { return V{radii.x * v.x, radii.y * v.y, radii.z * v.z}; };
    const auto gap_along = [&](V n) { return dot(n, point) - length(stretched(n)); };
    Foot f{0, stretched(unit_or(t, up)), unit_or(normal, up)};
    const V away = point - f.point;
    double lo = gap_along(f.normal), hi = length(away);
    if (is_inside()) {
        const double lambda = shift - radii[least] * radii[least];
        hi = -std::sqrt(std::max(lambda * (dot(point, divided(point)) - 1), 0.0));
    } else {
        const V n = unit_or(away, f.normal);
        if (const double gap = gap_along(n); gap > lo)
            lo = gap, f.normal = n;
    }
    f.distance = .5 * (lo + hi);
    f.width = std::max(.5 * (hi - lo), 0.0);
    return f;
}

Foot foot(V p, const Ellipsoid& s) {
    EllipsoidFoot search(p, s.radii);
    search.solve();
    return search.foot();
}

} // namespace boxwood::convex::detail
