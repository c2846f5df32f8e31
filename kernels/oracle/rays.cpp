#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/exact_vector.h"

#include <cmath>

namespace boxwood::oracle {

std::optional<RayPoint> ray_triangle(const Ray<float>& ray, const Triangle<float>& triangle) {
    const Unit unit(ray.origin, ray.direction, triangle.a, triangle.b, triangle.c);
    const Point o = unit(ray.origin), d = unit(ray.direction), a = unit(triangle.a),
                ab = unit(triangle.b) - a, ac = unit(triangle.c) - a;
    const Point n = cross(ab, ac), from_a = o - a;
    const Integer speed = dot(n, d);
    if (speed == 0)
        return std::nullopt;
    // The point o + t d of the plane, with t = height / speed, is (from_a speed + d height) / speed
    // from a.
    const Integer height = -dot(n, from_a);
    const Point x = speed * from_a + height * d;
    const Integer scale = speed * dot(n, n);
    RayPoint p{mpq_class(height, speed), mpq_class(dot(n, cross(x, ac)), scale),
               mpq_class(dot(n, cross(ab, x)), scale)};
    p.t.canonicalize();
    p.u.canonicalize();
    p.v.canonicalize();
    if (p.u < 0 || p.v < 0 || p.u + p.v > 1 || p.t < exact(ray.t_min) ||
        (!std::isinf(ray.t_max) && p.t > exact(ray.t_max)))
        return std::nullopt;
    return p;
}

bool ray_box(const Ray<float>& ray, const Aabb<float>& box) {
    if (box.is_empty())
        return false;
    mpq_class enter = exact(ray.t_min), leave = 0;
    bool bounded = !std::isinf(ray.t_max);
    if (bounded)
        leave = exact(ray.t_max);
    for (int axis = 0; axis < 3; ++axis) {
        const mpq_class o = exact(ray.origin[axis]), d = exact(ray.direction[axis]),
                        low = exact(box.min[axis]), high = exact(box.max[axis]);
        if (d == 0) {
            if (o < low || o > high)
                return false;
            continue;
        }
        const mpq_class t_low = (low - o) / d, t_high = (high - o) / d;
        const mpq_class &near = d > 0 ? t_low : t_high, &far = d > 0 ? t_high : t_low;
        if (near > enter)
            enter = near;
        if (!bounded || far < leave)
            leave = far;
        bounded = true;
    }
    return !bounded || enter <= leave;
}

} // namespace boxwood::oracle
