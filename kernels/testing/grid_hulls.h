#pragma once

#include "kernels/primitives/triangle.h"

#include <gmpxx.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

/// What the oracle is held against on small integers, by a method that has nothing in common with
/// its own. Two convex hulls share a point iff 0 lies in the hull of the differences of their
/// corners, and their distance is that of 0 to it. By Caratheodory only simplices of corners need
/// be looked at.
namespace boxwood::oracle {

__extension__ typedef __int128 Wide;
using Grid = std::array<std::int64_t, 3>;

inline Grid minus(const Grid& a, const Grid& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline std::array<Wide, 3> normal(const Grid& a, const Grid& b) {
    return {Wide(a[1]) * b[2] - Wide(a[2]) * b[1], Wide(a[2]) * b[0] - Wide(a[0]) * b[2],
            Wide(a[0]) * b[1] - Wide(a[1]) * b[0]};
}
template <class A, class B> Wide product(const A& a, const B& b) {
    return Wide(a[0]) * b[0] + Wide(a[1]) * b[1] + Wide(a[2]) * b[2];
}

struct Fraction {
    Wide num, den;
    bool operator<(const Fraction& b) const { return num * b.den < b.num * den; }
};

inline mpq_class rational(const Fraction& f) {
    return mpq_class(static_cast<long>(f.num)) / mpq_class(static_cast<long>(f.den));
}

/// The squared distance of the origin to the hull of the points.
inline Fraction origin_to_hull(const std::vector<Grid>& p) {
    Fraction best{product(p[0], p[0]), 1};
    const auto offer = [&](Wide num, Wide den) {
        if (const Fraction f{num, den}; f < best)
            best = f;
    };
    for (std::size_t i = 0; i < p.size(); ++i) {
        offer(product(p[i], p[i]), 1);
        for (std::size_t j = i + 1; j < p.size(); ++j) {
            const Grid ij = minus(p[j], p[i]);
            const Wide at = -product(p[i], ij), end = product(ij, ij);
            if (end > 0 && at >= 0 && at <= end) {
                const auto moment = normal(p[i], ij);
                offer(product(moment, moment), end);
            }
            for (std::size_t k = j + 1; k < p.size(); ++k) {
                const auto n = normal(ij, minus(p[k], p[i]));
                const Wide nn = product(n, n), height = product(n, p[i]);
                if (nn == 0)
                    continue;
                const Wide u = product(n, normal(p[i], p[j])), v = product(n, normal(p[j], p[k])),
                           w = product(n, normal(p[k], p[i]));
                if (u >= 0 && v >= 0 && w >= 0)
                    offer(height * height, nn);
                for (std::size_t l = k + 1; l < p.size(); ++l) {
                    // Is 0 in the tetrahedron: on the inner side of its four faces?
                    const Wide six = product(n, minus(p[l], p[i]));
                    if (six == 0)
                        continue;
                    const auto det = [](const Grid& a, const Grid& b, const Grid& c) {
                        return product(normal(a, b), c);
                    };
                    const int turn = six > 0 ? 1 : -1;
                    if (turn * det(p[j], p[k], p[l]) >= 0 && turn * det(p[i], p[l], p[k]) >= 0 &&
                        turn * det(p[i], p[j], p[l]) >= 0 && turn * det(p[i], p[k], p[j]) >= 0)
                        return {0, 1};
                }
            }
        }
    }
    return best;
}

inline Fraction hull_to_hull(const std::vector<Grid>& a, const std::vector<Grid>& b) {
    std::vector<Grid> differences;
    for (const Grid& p : a)
        for (const Grid& q : b)
            differences.push_back(minus(p, q));
    return origin_to_hull(differences);
}

inline Vec3<double> point(const Grid& g) {
    return {static_cast<double>(g[0]), static_cast<double>(g[1]), static_cast<double>(g[2])};
}
inline Triangle<double> triangle(const std::vector<Grid>& g) {
    return {point(g[0]), point(g[1]), point(g[2])};
}

/// n points of the grid [0, side]^3.
inline std::vector<Grid> random_points(std::mt19937_64& random, std::size_t n, int side) {
    std::uniform_int_distribution<std::int64_t> coordinate(0, side);
    std::vector<Grid> all(n);
    for (Grid& g : all)
        for (auto& x : g)
            x = coordinate(random);
    return all;
}

} // namespace boxwood::oracle
