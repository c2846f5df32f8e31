#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"

#include <array>

/// The truth, in rational arithmetic: every finite double is a rational number, and nothing here
/// rounds. Slow (microseconds to milliseconds), allocates, and shares no code with what it judges.
/// A target of its own (boxwood_oracle, GMP: LGPL) that tests and the bench link, the kernels not.
/// All input must be finite. Here: yes or no. Numbers, as rationals: exact_answers.h.
namespace boxwood::oracle {

/// Whether the closed triangles share a point; degenerate ones are the segment or point they are.
bool intersect(const Triangle<double>& a, const Triangle<double>& b);

/// Whether a point of the ray, t_min <= t <= t_max, lies in the closed box.
bool ray_box(const Ray<float>& ray, const Aabb<float>& box);

/// Whether two closed boxes in any pose share a point. Each is given by its centre, its three axis
/// vectors as they stand (not normalised, perhaps not quite orthogonal) and half sizes along them:
/// the parallelepiped centre + sum s_k half_k axis_k, |s_k| <= 1.
bool boxes_touch(const std::array<Vec3<double>, 4>& centre_and_axes_a, Vec3<double> half_a,
                 const std::array<Vec3<double>, 4>& centre_and_axes_b, Vec3<double> half_b);

} // namespace boxwood::oracle
