#pragma once

#include "kernels/oracle/oracle.h"
#include "kernels/primitives/rigid_transform.h"
#include "kernels/primitives/segment.h"

#include <gmpxx.h>

#include <array>
#include <optional>

/// The oracle's numbers, as rationals. All input must be finite.
namespace boxwood::oracle {

using RationalPoint = std::array<mpq_class, 3>;

/// Squared minimum distances; 0 exactly when the two share a point. Any of them may be degenerate.
mpq_class squared_distance(const Triangle<double>& a, const Triangle<double>& b);
mpq_class squared_distance(const Segment<double>& a, const Segment<double>& b);
mpq_class squared_distance(Vec3<double> a, const Triangle<double>& b);
mpq_class squared_distance(Vec3<double> a, const Segment<double>& b);

/// The double nearest to the square root of q >= 0, and (d - sqrt(q)) in ulps of that double.
double nearest_sqrt(const mpq_class& q);
double ulps_off(double d, const mpq_class& squared);
/// The sign of d - sqrt(q), exact: squares are compared, never roots. d is finite or infinite.
int compare(double d, const mpq_class& squared);

/// Where the ray meets the closed triangle, t_min <= t <= t_max; nothing if it doesn't. A ray in
/// the triangle's plane misses, as everywhere in the field, and a degenerate triangle is never hit.
struct RayPoint {
    mpq_class t, u, v;

    bool operator==(const RayPoint&) const = default;
};
std::optional<RayPoint> ray_triangle(const Ray<float>& ray, const Triangle<float>& triangle);

/// The least axis-aligned box that holds the image of a box that is not empty, under the matrix as
/// it stands.
struct RationalBox {
    RationalPoint min, max;
};
RationalBox image(const RigidTransform<double>& transform, const Aabb<double>& box);

} // namespace boxwood::oracle
