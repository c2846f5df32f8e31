#include "bench/truth/ray_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace boxwood::bench {
namespace {

using Vec = Vec3<double>;
constexpr double inf = std::numeric_limits<double>::infinity();

/// Rounding errors of a float kernel, in units of 2^-24: subtracting the origin (1), two products
/// and their difference (3), a dot product (4), and the same again for the shear of Woop's kernel.
constexpr double rounding = 16 * 0x1p-24;
/// Rings of rays this many rounding errors around the ray tell whether a mesh is closed there.
constexpr double ring = 4;
/// Triangles that a ray of the ring may meet: more than ring + 1 rounding errors.
constexpr double near = 8;

double longest_edge(const std::array<Vec, 3>& v) {
    return std::max({length(v[1] - v[0]), length(v[2] - v[1]), length(v[0] - v[2])});
}

/// A ray line against a triangle. With a, b, c the corners seen from the origin, the three signed
/// volumes d.(b x c), d.(c x a), d.(a x b) have one sign iff the line passes inside.
struct Test {
    std::array<double, 3> volume;
    double det;             ///< their sum, d.n with n the doubled area vector
    double distance;        ///< origin to the farthest corner
    double size;            ///< longest edge
    double d;               ///< length of the direction
    double t;               ///< where the line meets the plane
    double t_first, t_last; ///< the corners' places along the ray

    Test(Vec origin, Vec direction, const std::array<Vec, 3>& corners) {
        const Vec a = corners[0] - origin, b = corners[1] - origin, c = corners[2] - origin;
        volume = {dot(direction, cross(b, c)), dot(direction, cross(c, a)),
                  dot(direction, cross(a, b))};
        det = volume[0] + volume[1] + volume[2];
        distance = std::sqrt(std::max({dot(a, a), dot(b, b), dot(c, c)}));
        size = longest_edge(corners);
        const double dd = dot(direction, direction);
        d = std::sqrt(dd);
        t = dot(a, cross(b - a, c - a)) / det;
        const std::array along{dot(a, direction) / dd, dot(b, direction) / dd,
                               dot(c, direction) / dd};
        t_first = std::min({along[0], along[1], along[2]});
        t_last = std::max({along[0], along[1], along[2]});
    }

    /// The error of a signed volume in a float kernel: relative to |d| |corner| |edge|.
    double band() const { return rounding * d * distance * size; }

    bool inside(double margin) const {
        return (volume[0] > margin && volume[1] > margin && volume[2] > margin) ||
               (volume[0] < -margin && volume[1] < -margin && volume[2] < -margin);
    }
    bool outside(double margin) const {
        const auto [min_volume, max_volume] = std::minmax({volume[0], volume[1], volume[2]});
        return min_volume < -margin && max_volume > margin;
    }
    /// Error of t in a float kernel: a barycentric error of band/|det| moves the hit by no more
    /// than the size; then t itself is rounded.
    double t_error() const { return band() / std::abs(det) * size / d + rounding * (distance / d); }
};

std::array<Vec, 3> corners_of(const TriangleMesh& mesh, std::uint32_t i) {
    const Triangle<float> t = mesh.triangle(i);
    return {Vec(t.a), Vec(t.b), Vec(t.c)};
}

/// The candidate's place against the ray's ends: none if beyond them, ambiguous if across one.
std::optional<RayTruth::Candidate> candidate(const Test& test, std::uint32_t triangle,
                                             const Ray<float>& ray) {
    const double margin = test.band();
    if (test.outside(margin))
        return std::nullopt;
    RayTruth::Candidate c{triangle, test.inside(margin), 0, 0, test.t};
    if (c.certain) {
        c.t_low = test.t - test.t_error();
        c.t_high = test.t + test.t_error();
    } else {
        const double error = rounding * (test.distance / test.d);
        c.t_low = test.t_first - error;
        c.t_high = test.t_last + error;
    }
    const double t_min = static_cast<double>(ray.t_min), t_max = static_cast<double>(ray.t_max);
    if (!(c.t_low <= t_max && c.t_high >= t_min))
        return std::nullopt;
    if (!(c.t_low > t_min && c.t_high < t_max))
        c.certain = false;
    if (!c.certain)
        c.t = std::numeric_limits<double>::quiet_NaN();
    return c;
}

/// The farthest of the nearest hits of 16 rays around this one, infinite if one of them misses.
double limit_of_ring(const TriangleMesh& mesh, const Ray<float>& ray,
                     const std::vector<std::uint32_t>& nearby, double radius) {
    const Vec direction(ray.direction), origin(ray.origin);
    const Vec other = std::abs(direction.x) < 0.5 * length(direction) ? Vec{1, 0, 0} : Vec{0, 1, 0};
    Vec u = cross(direction, other);
    u = u * (1 / length(u));
    const Vec v = cross(direction, u) * (1 / length(direction));
    const double t_min = static_cast<double>(ray.t_min), t_max = static_cast<double>(ray.t_max);
    double limit = -inf;
    for (int k = 0; k < 16; ++k) {
        const double angle = (k + 0.37) * std::numbers::pi / 8;
        const Vec shifted = origin + (std::cos(angle) * u + std::sin(angle) * v) * radius;
        double nearest = inf;
        for (const std::uint32_t i : nearby) {
            const Test test(shifted, direction, corners_of(mesh, i));
            if (!test.inside(0))
                continue;
            const double error = test.t_error() + ring * rounding * test.distance / test.d;
            if (test.t - error > t_min && test.t + error < t_max)
                nearest = std::min(nearest, std::min(test.t + error, test.t_last + error));
        }
        limit = std::max(limit, nearest);
    }
    return limit;
}

} // namespace

RayOracle::RayOracle(const TriangleMesh& mesh) : mesh_(mesh) {
    balls_.reserve(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::array<Vec, 3> corners = corners_of(mesh, i);
        balls_.push_back({corners[0], longest_edge(corners)});
    }
}

template <class F> void RayOracle::for_nearby(const Ray<float>& ray, const F& f) const {
    const Vec origin(ray.origin), direction(ray.direction);
    const double dd = dot(direction, direction);
    for (std::uint32_t i = 0; i < balls_.size(); ++i) {
        // Off the ball that holds the triangle, by more than rounding: a miss, also for triangles
        // without area, whose volumes may vanish anywhere.
        const Vec corner = balls_[i].corner - origin, off = cross(corner, direction);
        const double farthest =
            std::abs(corner.x) + std::abs(corner.y) + std::abs(corner.z) + balls_[i].size;
        const double radius = balls_[i].size + near * rounding * farthest;
        if (dot(off, off) > dd * radius * radius)
            continue;
        const Test test(origin, direction, corners_of(mesh_, i));
        if (!test.outside(near * test.band()))
            f(test, i);
    }
}

RayTruth RayOracle::truth(const Ray<float>& ray) const {
    RayTruth truth;
    std::vector<std::uint32_t> nearby;
    double reach = 0; ///< farthest corner of an ambiguous triangle
    for_nearby(ray, [&](const Test& test, std::uint32_t i) {
        nearby.push_back(i);
        if (const auto c = candidate(test, i, ray)) {
            truth.candidates.push_back(*c);
            if (c->certain)
                truth.t_limit = std::min(truth.t_limit, c->t_high);
            else
                reach = std::max(reach, test.distance);
        }
    });
    if (reach > 0)
        truth.t_limit =
            std::min(truth.t_limit, limit_of_ring(mesh_, ray, nearby, ring * rounding * reach));
    std::erase_if(truth.candidates,
                  [&](const RayTruth::Candidate& c) { return c.t_low > truth.t_limit; });
    return truth;
}

std::vector<RayTruth::Candidate> RayOracle::all(const Ray<float>& ray) const {
    std::vector<RayTruth::Candidate> found;
    for_nearby(ray, [&](const Test& test, std::uint32_t i) {
        if (const auto c = candidate(test, i, ray))
            found.push_back(*c);
    });
    return found;
}

} // namespace boxwood::bench
