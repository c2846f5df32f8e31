/// The exact ray kernel against rationals: whether it hits, and t, u and v within its bounds.

#include "bench/fuzz/fuzz.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/roots.h"
#include "kernels/ray_triangle/exact.h"

#include <cmath>

namespace boxwood::fuzz {

void ray_triangle(Bytes bytes) {
    Coordinates in(bytes);
    Ray<float> ray;
    Triangle<float> t;
    for (Vec3<float>* point : {&ray.origin, &ray.direction, &t.a, &t.b, &t.c})
        for (int axis = 0; axis < 3; ++axis)
            (*point)[axis] = in.next<float>();
    if (const float t_max = in.next<float>(); t_max > 0)
        ray.t_max = t_max;
    RayHit hit;
    const auto per_ray = ExactRayTriangle::prepare(ray);
    const bool hits = ExactRayTriangle::intersect(per_ray, ray, t, ray.t_max, hit);
    if (!is_finite(ray.origin) || !is_finite(ray.direction) || !is_finite(t.a) || !is_finite(t.b) ||
        !is_finite(t.c)) {
        require(!hits, "a hit of what is not finite");
        return;
    }
    const auto truth = oracle::ray_triangle(ray, t);
    if (hits != truth.has_value()) {
        const bool is_beyond_floats = truth && std::isinf(oracle::nearest_float(truth->t));
        require(!hits && is_beyond_floats, hits ? "a false hit" : "a miss");
        return;
    }
    if (!hits)
        return;
    const auto near = [](float value, const mpq_class& right) {
        return abs(mpq_class(static_cast<double>(value)) - right) <= mpq_class(0x1p-23);
    };
    require(near(hit.u, truth->u) && near(hit.v, truth->v), "u or v is off by more than 2^-23");
    // An ulp of the binade of the truth; denormal ones are all alike.
    const double t_double = truth->t.get_d();
    if (t_double < 0x1.fffffep127) {
        const int exponent = t_double == 0 ? -126 : std::max(std::ilogb(t_double), -126);
        const mpq_class ulp(std::ldexp(1.0, exponent - 23));
        require(std::isfinite(hit.t) && abs(mpq_class(static_cast<double>(hit.t)) - truth->t) <=
                                            ulp * mpq_class(63, 100),
                "t is off by more than 0.63 ulp");
    } else {
        require(hit.t >= 0x1.fffffep127f, "t beyond the largest float is small");
    }
}

} // namespace boxwood::fuzz
