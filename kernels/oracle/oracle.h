#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/rigid_transform.h"
#include "kernels/continuous/continuous_kernel.h"
#include "kernels/primitives/ray.h"
#include "kernels/primitives/segment.h"
#include "kernels/primitives/triangle.h"

#include <gmpxx.h>

#include <array>
#include <optional>

/// The truth, in rational arithmetic: every finite double is a rational number, and nothing here
/// rounds. Slow (microseconds to milliseconds), allocates, and shares no code with what it judges.
/// A target of its own (boxwood_oracle, GMP: LGPL) that tests and the bench link, the kernels not.
/// All input must be finite.
namespace boxwood::oracle {

using RationalPoint = std::array<mpq_class, 3>;

/// Whether the closed triangles share a point; degenerate ones are the segment or point they are.
bool intersect(const Triangle<double>& a, const Triangle<double>& b);

/// Squared least distances; 0 exactly when the two share a point. Any of them may be degenerate.
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
};
std::optional<RayPoint> ray_triangle(const Ray<float>& ray, const Triangle<float>& triangle);

/// Whether a point of the ray, t_min <= t <= t_max, lies in the closed box.
bool ray_box(const Ray<float>& ray, const Aabb<float>& box);

/// Whether two closed boxes in any pose share a point. Each is given by its centre, its three axis
/// vectors as they stand (not normalised, perhaps not quite orthogonal) and half sizes along them:
/// the parallelepiped centre + sum s_k half_k axis_k, |s_k| <= 1.
bool boxes_touch(const std::array<Vec3<double>, 4>& centre_and_axes_a, Vec3<double> half_a,
                 const std::array<Vec3<double>, 4>& centre_and_axes_b, Vec3<double> half_b);

/// The least axis-aligned box that holds the image of a box that is not empty, under the matrix as
/// it stands.
struct RationalBox {
    RationalPoint min, max;
};
RationalBox image(const RigidTransform<double>& transform, const Aabb<double>& box);

} // namespace boxwood::oracle
