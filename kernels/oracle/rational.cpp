#include "kernels/oracle/rational.h"

#include "kernels/oracle/nearest.h"
#include "kernels/oracle/roots.h"

#include <limits>

namespace boxwood::oracle {
namespace {

template <class Real> bool finite(Vec3<Real> p) { return is_finite(p); }
bool finite(const Segment<double>& s) { return is_finite(s.a) && is_finite(s.b); }
template <class Real> bool finite(const Triangle<Real>& t) {
    return is_finite(t.a) && is_finite(t.b) && is_finite(t.c);
}

Vec3<double> rounded(const RationalPoint& p) {
    return {nearest_double(p[0]), nearest_double(p[1]), nearest_double(p[2])};
}

template <class A, class B> Distance distance(const A& a, const B& b) {
    if (!finite(a) || !finite(b)) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        return {nan, nan, nan, {nan, nan, nan}, {nan, nan, nan}};
    }
    const Nearest exact = nearest(a, b);
    const double d = nearest_sqrt(exact.squared);
    const int side = compare(d, exact.squared);
    return {d, side > 0 ? next_below(d) : d, side < 0 ? next_above(d) : d, rounded(exact.a),
            rounded(exact.b)};
}

} // namespace

Decision RationalTriangles::intersect(const Triangle<double>& a, const Triangle<double>& b) {
    if (!finite(a) || !finite(b))
        return {Answer::maybe};
    return {oracle::intersect(a, b) ? Answer::yes : Answer::no};
}

Distance RationalTriangleDistance::distance(const Triangle<double>& a, const Triangle<double>& b) {
    return oracle::distance(a, b);
}
Distance RationalSegmentDistance::distance(const Segment<double>& a, const Segment<double>& b) {
    return oracle::distance(a, b);
}
Distance RationalPointTriangle::distance(Vec3<double> a, const Triangle<double>& b) {
    return oracle::distance(a, b);
}
Distance RationalPointSegment::distance(Vec3<double> a, const Segment<double>& b) {
    return oracle::distance(a, b);
}

bool RationalRays::intersect(PerRay, const Ray<float>& ray, const Triangle<float>& triangle,
                             float t_max, RayHit& hit) {
    if (!finite(ray.origin) || !finite(ray.direction) || !finite(triangle) ||
        !std::isfinite(ray.t_min) || std::isnan(t_max))
        return false;
    const auto met = ray_triangle({ray.origin, ray.direction, ray.t_min, t_max}, triangle);
    if (!met || std::isinf(nearest_float(met->t)))
        return false;
    hit.t = nearest_float(met->t);
    hit.u = nearest_float(met->u);
    hit.v = nearest_float(met->v);
    return true;
}

} // namespace boxwood::oracle
