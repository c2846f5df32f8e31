#include "bench/truth/judging/moved_corners.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood::bench {
namespace {

constexpr double roundoff = 0x1p-24, denormal = 0x1p-149;

/// The axis along the ray, as watertight.h has it; x and y follow it cyclically.
int depth_axis(Vec3<float> d) {
    const float x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
    return z >= std::max(x, y) ? 2 : y >= x ? 1 : 0;
}

bool is_in_range(Vec3<float> p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < max_ray_coordinate;
}

} // namespace

MovedCorners::MovedCorners(const Ray<float>& ray, const Triangle<float>& t)
    : ray_(ray), is_finite_(is_finite(t.a) && is_finite(t.b) && is_finite(t.c)) {
    is_in_range_ = is_in_range(t.a) && is_in_range(t.b) && is_in_range(t.c) &&
                   is_in_range(ray.origin) && is_finite(ray.direction);
    const int z = depth_axis(ray.direction), x = (z + 1) % 3, y = (z + 2) % 3;
    const Vec3<double> origin(ray.origin), direction(ray.direction);
    direction_z_ = direction[z];
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3<double> p = Vec3<double>(i == 0 ? t.a : i == 1 ? t.b : t.c) - origin;
        Corner& corner = corners_[i];
        corner.z = p[z];
        const auto across = [&](int axis, double& at, double& move) {
            const double sheared = direction[axis] / direction[z] * p[z];
            at = p[axis] - sheared;
            move = (2 * std::abs(p[axis]) + 4 * std::abs(sheared)) * roundoff * (1 + 0x1p-20) +
                   (std::abs(p[z]) + 1) * denormal;
        };
        across(x, corner.x, corner.move_x);
        across(y, corner.y, corner.move_y);
        max_z_ = std::max(max_z_, std::abs(p[z]));
    }
    edges_ = {edge(corners_[1], corners_[2]), edge(corners_[2], corners_[0]),
              edge(corners_[0], corners_[1])};
}

MovedCorners::Edge MovedCorners::edge(const Corner& p, const Corner& q) {
    const auto product_error = [](double a, double move_a, double b, double move_b) {
        return std::abs(a) * move_b + std::abs(b) * move_a + move_a * move_b;
    };
    return {p.x * q.y - p.y * q.x, product_error(p.x, p.move_x, q.y, q.move_y) +
                                       product_error(p.y, p.move_y, q.x, q.move_x)};
}

bool MovedCorners::allow(const RayHit& hit) const {
    if (!is_finite_)
        return false;
    if (!is_in_range_)
        return true;
    const auto t = static_cast<double>(hit.t), u = static_cast<double>(hit.u),
               v = static_cast<double>(hit.v);
    if (!(u >= 0 && v >= 0 && u + v <= 1 + 2 * roundoff && hit.t >= ray_.t_min &&
          hit.t <= ray_.t_max && hit.t < std::numeric_limits<float>::infinity()))
        return false;
    const Corner &a = corners_[0], &b = corners_[1], &c = corners_[2];
    const auto is_near = [&](double goal, double Corner::*at, double error) {
        const double there = a.*at + u * (b.*at - a.*at) + v * (c.*at - a.*at);
        const double weights = roundoff * (std::abs(b.*at - a.*at) + std::abs(c.*at - a.*at));
        return std::abs(there - goal) <= error + weights;
    };
    return is_near(0, &Corner::x, std::max({a.move_x, b.move_x, c.move_x})) &&
           is_near(0, &Corner::y, std::max({a.move_y, b.move_y, c.move_y})) &&
           is_near(t * direction_z_, &Corner::z,
                   roundoff * max_z_ + std::abs(direction_z_) * (roundoff * t + denormal));
}

bool MovedCorners::allow_a_hit() const {
    if (!is_finite_ || !is_in_range_)
        return is_finite_;
    const bool is_inside =
        std::ranges::all_of(edges_, [](const Edge& e) { return e.area >= -e.error; }) ||
        std::ranges::all_of(edges_, [](const Edge& e) { return e.area <= e.error; });
    const auto [near, far] = std::minmax(
        {corners_[0].z / direction_z_, corners_[1].z / direction_z_, corners_[2].z / direction_z_});
    const double error = 2 * roundoff * max_z_ / std::abs(direction_z_) + denormal;
    return is_inside && far + error >= static_cast<double>(ray_.t_min) &&
           near - error <= static_cast<double>(ray_.t_max);
}

/// A weight E / D, D the sum of the E, changes by at most (dE + w dD) / (D - dD); the depth, a
/// weighted sum, by that times the corners' depths below it.
std::optional<double> MovedCorners::surely_hit_by() const {
    if (!is_finite_ || !is_in_range_)
        return std::nullopt;
    const double sign = edges_[0].area < 0 ? -1 : 1;
    double sum = 0, sum_error = 0, depth = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(sign * edges_[i].area > edges_[i].error))
            return std::nullopt;
        sum += sign * edges_[i].area;
        sum_error += edges_[i].error;
        depth += sign * edges_[i].area * corners_[i].z;
    }
    depth /= sum;
    double error = roundoff * max_z_;
    for (std::size_t i = 0; i < 3; ++i)
        error += (edges_[i].error + sign * edges_[i].area / sum * sum_error) / (sum - sum_error) *
                 std::abs(corners_[i].z - depth);
    const double t = depth / direction_z_,
                 t_error = error / std::abs(direction_z_) + roundoff * std::abs(t) + denormal;
    const auto end = static_cast<double>(std::min(ray_.t_max, std::numeric_limits<float>::max()));
    return t - t_error > static_cast<double>(ray_.t_min) && t + t_error < end
               ? std::optional(t + t_error)
               : std::nullopt;
}

} // namespace boxwood::bench
