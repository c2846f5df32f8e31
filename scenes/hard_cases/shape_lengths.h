#pragma once

#include "kernels/convex/shapes.h"

#include <array>
#include <span>
#include <type_traits>
#include <vector>

namespace boxwood {

/// The lengths that make a shape, in the order of its members: of a hull the coordinates of its
/// points, of a half-space or plane normal and offset.
inline std::vector<double> lengths_of(const convex::Shape& shape) {
    return shape.visit([]<class S>(const S& s) -> std::vector<double> {
        const auto of = [](std::span<const Vec3<double>> points) {
            std::vector<double> lengths;
            lengths.reserve(3 * points.size());
            for (const Vec3<double>& p : points)
                for (int axis = 0; axis < 3; ++axis)
                    lengths.push_back(p[axis]);
            return lengths;
        };
        if constexpr (requires { s.half_length; }) {
            return {s.radius, s.half_length};
        } else if constexpr (requires { s.radius; }) {
            return {s.radius};
        } else if constexpr (requires { s.half; }) {
            return of(std::array{s.half});
        } else if constexpr (requires { s.radii; }) {
            return of(std::array{s.radii});
        } else if constexpr (requires { s.offset; }) {
            return {s.normal.x, s.normal.y, s.normal.z, s.offset};
        } else if constexpr (std::is_same_v<S, convex::Hull>) {
            return of(s.points());
        } else {
            return of(std::array{s.a, s.b, s.c});
        }
    });
}

} // namespace boxwood
