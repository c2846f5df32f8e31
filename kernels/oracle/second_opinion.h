#pragma once

#include "kernels/continuous/continuous_kernel.h"
#include "kernels/oracle/exact_answers.h"

#include <optional>
#include <span>

/// A second oracle, by other formulations, that shares no code with the first (GMP's numbers
/// apart): no oracle is its own judge. Slower still. All input must be finite.
namespace boxwood::oracle::second_opinion {

/// The squared distance of the convex hulls of up to three points each, 0 if they share one: the
/// greatest gap between parallel planes, where the first oracle takes the least distance of
/// features. Each gap is a lower bound and each distance an upper one, so that two that agree are
/// both right.
mpq_class squared_distance(std::span<const Vec3<double>> a, std::span<const Vec3<double>> b);

/// Where the ray meets the triangle, by elimination in o + t d = a + u (b - a) + v (c - a).
std::optional<RayPoint> ray_triangle(const Ray<float>& ray, const Triangle<float>& triangle);

/// Whether the first touch is as `claimed`: no, or within [t_free, t_hit], equal or neighbours, and
/// never before. By Sturm chains and Tarski queries on barycentric signs.
bool confirms_vertex_face(const LinearMotion& motion, const Impact& claimed);
bool confirms_edge_edge(const LinearMotion& motion, const Impact& claimed);

} // namespace boxwood::oracle::second_opinion
