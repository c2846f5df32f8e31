#pragma once

#include "kernels/primitives/rigid_transform.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace boxwood {

/// The rows of a 3 x 3 matrix.
using Rotation = std::array<Vec3<double>, 3>;

/// The matrix times v, rounded; and the transposed one.
[[gnu::always_inline]] inline Vec3<double> times(const Rotation& m, Vec3<double> v) {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}
[[gnu::always_inline]] inline Vec3<double> transposed_times(const Rotation& m, Vec3<double> v) {
    return v.x * m[0] + v.y * m[1] + v.z * m[2];
}

/// The matrix product a b, rounded.
inline Rotation product(const Rotation& a, const Rotation& b) {
    Rotation out;
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = a[i].x * b[0] + a[i].y * b[1] + a[i].z * b[2];
    return out;
}

/// The product of a transposed and b, rounded.
[[gnu::always_inline]] inline Rotation transposed_product(const Rotation& a, const Rotation& b) {
    return {a[0].x * b[0] + a[1].x * b[1] + a[2].x * b[2],
            a[0].y * b[0] + a[1].y * b[1] + a[2].y * b[2],
            a[0].z * b[0] + a[1].z * b[1] + a[2].z * b[2]};
}

/// The product of two rotations that are orthonormal to 2^-28, orthonormal to 16 roundings: two
/// rows, a Newton step for each towards length 1 and a right angle, and their cross product.
inline Rotation orthonormal_product(const Rotation& a, const Rotation& b) {
    Vec3<double> x = a[0].x * b[0] + a[0].y * b[1] + a[0].z * b[2];
    Vec3<double> y = a[1].x * b[0] + a[1].y * b[1] + a[1].z * b[2];
    x = x + (.5 - dot(x, x) / 2) * x;
    y = y + ((.5 - dot(y, y) / 2) * y - dot(x, y) * x);
    return {x, y, cross(x, y)};
}

/// x -> a(b(x)), rounded.
inline RigidTransform<double> compose(const RigidTransform<double>& a,
                                      const RigidTransform<double>& b) {
    return {product(a.rotation, b.rotation), a(b.translation)};
}

/// The rotation about an axis of length 1, right-handed, by Rodrigues' formula, from its angle's
/// sine and cosine; from radians.
inline Rotation rotation_about(Vec3<double> axis, double s, double c) {
    const Vec3<double> rest = (1 - c) * axis, turn = s * axis;
    return {{{rest.x * axis.x + c, rest.x * axis.y - turn.z, rest.x * axis.z + turn.y},
             {rest.y * axis.x + turn.z, rest.y * axis.y + c, rest.y * axis.z - turn.x},
             {rest.z * axis.x - turn.y, rest.z * axis.y + turn.x, rest.z * axis.z + c}}};
}
inline Rotation rotation_about(Vec3<double> axis, double angle) {
    return rotation_about(axis, std::sin(angle), std::cos(angle));
}

struct AxisAngle {
    Vec3<double> axis{0, 0, 1}; ///< of length 1
    double angle = 0;           ///< 0 to pi, radians
};

/// The least turn that takes the first rotation to the second, about an axis of space, off by a few
/// roundings. From the quaternion, whose greatest part is computed first, so that no angle is
/// ill-conditioned.
inline AxisAngle turn_between(const Rotation& from, const Rotation& to) {
    const Rotation r = product(to, {{{from[0].x, from[1].x, from[2].x},
                                     {from[0].y, from[1].y, from[2].y},
                                     {from[0].z, from[1].z, from[2].z}}});
    const double xx = r[0].x, yy = r[1].y, zz = r[2].z;
    std::array<double, 4> q{1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz};
    const auto greatest = static_cast<std::size_t>(std::ranges::max_element(q) - q.begin());
    const double x = r[2].y - r[1].z, y = r[0].z - r[2].x, z = r[1].x - r[0].y;
    const double xy = r[0].y + r[1].x, xz = r[0].z + r[2].x, yz = r[1].z + r[2].y;
    switch (greatest) { // times 4 of the greatest part
    case 0:
        q = {q[0], x, y, z};
        break;
    case 1:
        q = {x, q[1], xy, xz};
        break;
    case 2:
        q = {y, xy, q[2], yz};
        break;
    default:
        q = {z, xz, yz, q[3]};
    }
    Vec3<double> v{q[1], q[2], q[3]};
    double w = q[0];
    if (w < 0) {
        w = -w;
        v = -v;
    }
    const double size = length(v);
    if (!(size > 0))
        return {};
    return {(1 / size) * v, 2 * std::atan2(size, w)};
}

/// The largest entry of |R R^T - I|; of finite numbers.
inline double distance_from_orthonormal(const Rotation& r) {
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = i; j < 3; ++j)
            largest = std::max(largest, std::abs(dot(r[i], r[j]) - (i == j ? 1 : 0)));
    return largest;
}

/// One Newton step to the nearest rotation, R + (I - R R^T) R / 2: a matrix that is d from
/// orthonormal becomes one that is about d^2, or a few roundings, from it. Exact ones stay.
inline Rotation orthonormalised(const Rotation& r) {
    const double xx = .5 - dot(r[0], r[0]) / 2, yy = .5 - dot(r[1], r[1]) / 2,
                 zz = .5 - dot(r[2], r[2]) / 2;
    const double xy = -dot(r[0], r[1]) / 2, yz = -dot(r[1], r[2]) / 2, zx = -dot(r[2], r[0]) / 2;
    return {{r[0] + (xx * r[0] + xy * r[1] + zx * r[2]), r[1] + (xy * r[0] + yy * r[1] + yz * r[2]),
             r[2] + (zx * r[0] + yz * r[1] + zz * r[2])}};
}

} // namespace boxwood
