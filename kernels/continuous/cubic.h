#pragma once

#include "kernels/continuous/continuous_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace boxwood {

/// The classical method in plain double: the times at which the four points are coplanar are roots
/// of a cubic, and at each of them, the earliest first, barycentric weights say whether the
/// features meet. t_free = t_hit = the computed root. It is wrong where rounding moves a root or
/// a weight over an end (touches at t = 0 and 1, at edges and corners), where two roots fall
/// together (grazing), and blind where the cubic is 0 (no motion, coplanar all along, parallel
/// edges). NaN or infinity: maybe. Source: Provot 1997, "Collision and Self-Collision Handling in
/// Cloth Model Dedicated to Design Garments".
struct CubicF64 {
    static constexpr std::string_view name = "cubic_f64";
    static constexpr KernelInfo vertex_face_info{
        "vertex_face",
        name,
        "roots of the coplanarity cubic in double, inside test (Provot 1997)",
        Promise::none,
        "none: rounding moves roots and weights over their limits",
        "about 200 flops"};
    static constexpr KernelInfo edge_edge_info{"edge_edge",
                                               name,
                                               vertex_face_info.summary,
                                               vertex_face_info.promise,
                                               vertex_face_info.bound,
                                               vertex_face_info.cost};

    Impact vertex_face(const LinearMotion& motion) const { return first<Face>(motion); }
    Impact edge_edge(const LinearMotion& motion) const { return first<Edges>(motion); }

  private:
    using Vector = Vec3<double>;
    using Points = std::array<Vector, 4>;
    using Cubic = std::array<double, 4>; ///< c[0] + c[1] t + c[2] t^2 + c[3] t^3

    /// Two vectors that span the plane and one that joins the features; whether these meet where
    /// the three are coplanar.
    struct Face {
        static std::array<Vector, 3> vectors(const Points& p) {
            return {p[2] - p[1], p[3] - p[1], p[0] - p[1]};
        }
        static bool meet(const std::array<Vector, 3>& e) {
            const Vector normal = cross(e[0], e[1]);
            const double area = dot(normal, normal);
            const double u = dot(cross(e[2], e[1]), normal), v = dot(cross(e[0], e[2]), normal);
            return area > 0 && u >= 0 && v >= 0 && u + v <= area;
        }
    };
    struct Edges {
        static std::array<Vector, 3> vectors(const Points& p) {
            return {p[1] - p[0], p[3] - p[2], p[2] - p[0]};
        }
        static bool meet(const std::array<Vector, 3>& e) {
            const Vector normal = cross(e[0], e[1]);
            const double area = dot(normal, normal);
            const double u = dot(cross(e[2], e[1]), normal), v = dot(cross(e[2], e[0]), normal);
            return area > 0 && u >= 0 && u <= area && v >= 0 && v <= area;
        }
    };

    template <class Features> static Impact first(const LinearMotion& motion) {
        for (std::size_t i = 0; i < 4; ++i)
            if (!is_finite(motion.start[i]) || !is_finite(motion.end[i]))
                return {Answer::maybe, 0, 1, 0};
        const auto from = Features::vectors(motion.start), to = Features::vectors(motion.end);
        const Cubic cubic = triple(from, {to[0] - from[0], to[1] - from[1], to[2] - from[2]});
        std::array<double, 4> cut{0, 1, 1, 1};
        const std::size_t n_cuts = turns_between(cubic, cut);
        for (std::size_t i = 0; i + 1 < n_cuts; ++i) {
            const double t = root_of_monotone(cubic, cut[i], cut[i + 1]);
            if (!(t <= 1))
                continue;
            const auto mean = [t](Vector a, Vector b) { return a * (1 - t) + b * t; };
            if (Features::meet({mean(from[0], to[0]), mean(from[1], to[1]), mean(from[2], to[2])}))
                return {Answer::yes, t, t, 0};
        }
        return {};
    }

    /// The triple product of (from + t change)[0 .. 2].
    static Cubic triple(const std::array<Vector, 3>& from, const std::array<Vector, 3>& change) {
        const Vector n0 = cross(from[0], from[1]);
        const Vector n1 = cross(from[0], change[1]) + cross(change[0], from[1]);
        const Vector n2 = cross(change[0], change[1]);
        return {dot(n0, from[2]), dot(n0, change[2]) + dot(n1, from[2]),
                dot(n1, change[2]) + dot(n2, from[2]), dot(n2, change[2])};
    }
    static double value(const Cubic& c, double t) {
        return ((c[3] * t + c[2]) * t + c[1]) * t + c[0];
    }

    /// Cuts [0, 1] where the cubic turns: it is monotone between neighbours of cut[0 .. returned).
    static std::size_t turns_between(const Cubic& cubic, std::array<double, 4>& cut) {
        std::size_t n = 1;
        const double a = 3 * cubic[3], b = 2 * cubic[2], c = cubic[1];
        if (const double square = b * b - 4 * a * c; square >= 0) {
            const double q = -(b + std::copysign(std::sqrt(square), b)) / 2;
            const double s = c / q, t = q / a;
            for (const double turn : {std::min(s, t), std::max(s, t)})
                if (turn > 0 && turn < 1)
                    cut[n++] = turn;
        }
        cut[n++] = 1;
        return n;
    }

    /// By bisection; NaN if there is none.
    static double root_of_monotone(const Cubic& cubic, double low, double high) {
        const double at_low = value(cubic, low), at_high = value(cubic, high);
        if (at_low == 0 && at_high != 0)
            return low;
        if (!((at_low < 0 && at_high >= 0) || (at_low > 0 && at_high <= 0)))
            return std::numeric_limits<double>::quiet_NaN();
        for (int step = 0; step < 54; ++step) {
            const double middle = (low + high) / 2, at = value(cubic, middle);
            ((at_low < 0) == (at < 0) && at != 0 ? low : high) = middle;
        }
        return high;
    }
};

} // namespace boxwood
