#pragma once

#include "kernels/primitives/vec3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace boxwood::detail::inclusion {

/// The point nearest to the origin on a flat convex polygon, n = 3, or a parallelogram, n = 4.
template <int n> struct Nearest {
    Vec3<double> direction{};        ///< from the origin to it, largest component 1; 0 if unknown
    Vec3<double> normal{};           ///< of the polygon, towards it from the origin; or 0
    std::array<double, n> weights{}; ///< of the corners, sum 1
    double distance = 0;
};

/// v over its largest component; 0 for 0.
inline Vec3<double> normalised(Vec3<double> v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest > 0 ? Vec3<double>{v.x / largest, v.y / largest, v.z / largest} : Vec3<double>{};
}

/// In plain doubles, no promise: a guess at the plane that separates best. The direction is
/// accurate across an edge and across the polygon also where it is very near: both come from cross
/// products, not from the difference of the nearest points.
template <int n> Nearest<n> nearest_to_origin(const std::array<Vec3<double>, n>& corner) {
    Nearest<n> nearest;
    const auto next = [](std::size_t i) { return i + 1 == n ? 0 : i + 1; };
    const Vec3<double> u = corner[1] - corner[0], v = corner[n - 1] - corner[0];
    const Vec3<double> normal = cross(u, v);
    const double square = dot(normal, normal);
    bool above = square > 0;
    std::array<double, n> side;
    for (std::size_t i = 0; i < n; ++i) {
        side[i] = dot(normal, cross(corner[i], corner[next(i)]));
        above = above && side[i] >= 0;
    }
    const double height = dot(normal, corner[0]);
    nearest.normal = height >= 0 ? normal : -normal;
    if (above) {
        nearest.direction = normalised(nearest.normal);
        nearest.distance = std::abs(height) / std::sqrt(square);
        if constexpr (n == 3) {
            nearest.weights = {side[1] / square, side[2] / square, side[0] / square};
        } else {
            const double x = side[3] / square, y = side[0] / square;
            nearest.weights = {(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
        }
        return nearest;
    }
    std::size_t edge = 0;
    double min_length = std::numeric_limits<double>::infinity(), place = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3<double> e = corner[next(i)] - corner[i];
        const double length2 = dot(e, e);
        const double x = length2 > 0 ? std::clamp(-dot(corner[i], e) / length2, 0.0, 1.0) : 0;
        const Vec3<double> p = corner[i] + e * x;
        if (const double d2 = dot(p, p); d2 < min_length) {
            min_length = d2;
            edge = i;
            place = x;
        }
    }
    const Vec3<double> e = corner[next(edge)] - corner[edge];
    const Vec3<double> p = corner[edge] + e * place;
    Vec3<double> direction = p;
    if (place > 0 && place < 1) {
        direction = cross(e, cross(corner[edge], e));
        if (dot(direction, p) < 0)
            direction = -direction;
    }
    nearest.direction = normalised(direction);
    nearest.weights[edge] = 1 - place;
    nearest.weights[next(edge)] = place;
    nearest.distance = std::sqrt(min_length);
    return nearest;
}

} // namespace boxwood::detail::inclusion
