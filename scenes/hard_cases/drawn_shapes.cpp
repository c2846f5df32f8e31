#include "scenes/hard_cases/drawn_shapes.h"

#include "scenes/hard_cases/lattice.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace boxwood {
namespace {

using convex::ShapeKind;
using Vec = Vec3<double>;

constexpr double slack = 0x1p-44;

constexpr ShapeKind kinds[] = {ShapeKind::sphere,   ShapeKind::box,  ShapeKind::capsule,
                               ShapeKind::cylinder, ShapeKind::cone, ShapeKind::ellipsoid,
                               ShapeKind::hull};

/// The icosahedron with each face cut in four, on the unit sphere: 42 points, 80 faces. The ball of
/// radius `geodesic_inside` fits in it.
constexpr double geodesic_inside = 0.93;
Polyhedron geodesic_sphere() {
    const double golden = (1 + std::sqrt(5.0)) / 2;
    std::vector<Vec> points;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-golden, golden}) {
            points.push_back({0, a, b});
            points.push_back({a, b, 0});
            points.push_back({b, 0, a});
        }
    const auto are_joined = [&](std::size_t i, std::size_t j) {
        return length(points[i] - points[j]) < 2.5; // the edges are 2 long, all else 3.2 or more
    };
    const std::size_t n = points.size();
    std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> middles;
    const auto middle = [&](std::size_t i, std::size_t j) {
        const auto [at, is_new] =
            middles.try_emplace(std::minmax(i, j), static_cast<std::uint32_t>(points.size()));
        if (is_new)
            points.push_back(0.5 * (points[i] + points[j]));
        return at->second;
    };
    Polyhedron made;
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = i + 1; j < n; ++j)
            for (std::uint32_t k = j + 1; k < n; ++k) {
                if (!are_joined(i, j) || !are_joined(j, k) || !are_joined(k, i))
                    continue;
                const bool turns_out =
                    dot(cross(points[j] - points[i], points[k] - points[i]), points[i]) > 0;
                const std::uint32_t second = turns_out ? j : k, third = turns_out ? k : j;
                const std::uint32_t a = middle(i, second), b = middle(second, third),
                                    c = middle(third, i);
                for (const auto& face : {std::array{i, a, c}, std::array{a, second, b},
                                         std::array{c, b, third}, std::array{a, b, c}})
                    made.faces.push_back(face);
            }
    for (Vec& p : points)
        p = p * (1 / length(p));
    made.points = std::move(points);
    return made;
}

Vec farthest(const convex::Sphere& s, Vec n) { return n * (s.radius / length(n)); }
Vec farthest(const convex::Box& s, Vec n) {
    return {std::copysign(s.half.x, n.x), std::copysign(s.half.y, n.y),
            std::copysign(s.half.z, n.z)};
}
Vec farthest(const convex::Capsule& s, Vec n) {
    return farthest(convex::Sphere{s.radius}, n) + Vec{0, 0, std::copysign(s.half_length, n.z)};
}
/// On the circle of this radius at this height.
Vec farthest_on_rim(double radius, double z, Vec n) {
    const double across = std::sqrt(n.x * n.x + n.y * n.y);
    return across > 0 ? Vec{radius * n.x / across, radius * n.y / across, z} : Vec{radius, 0, z};
}
Vec farthest(const convex::Cylinder& s, Vec n) {
    return farthest_on_rim(s.radius, std::copysign(s.half_length, n.z), n);
}
Vec farthest(const convex::Cone& s, Vec n) {
    const Vec apex{0, 0, s.half_length}, rim = farthest_on_rim(s.radius, -s.half_length, n);
    return dot(apex, n) >= dot(rim, n) ? apex : rim;
}
Vec farthest(const convex::Ellipsoid& s, Vec n) {
    const Vec stretched{s.radii.x * n.x, s.radii.y * n.y, s.radii.z * n.z};
    const double size = length(stretched);
    return {s.radii.x * stretched.x / size, s.radii.y * stretched.y / size,
            s.radii.z * stretched.z / size};
}
Vec farthest(const convex::Hull& s, Vec n) {
    return *std::ranges::max_element(s.points(), {}, [&](Vec p) { return dot(p, n); });
}

Ball ball_inside(const convex::Sphere& s) { return {{}, s.radius}; }
Ball ball_inside(const convex::Box& s) { return {{}, std::min({s.half.x, s.half.y, s.half.z})}; }
Ball ball_inside(const convex::Capsule& s) { return {{}, s.radius}; }
Ball ball_inside(const convex::Cylinder& s) { return {{}, std::min(s.radius, s.half_length)}; }
Ball ball_inside(const convex::Cone& s) {
    const double height = 2 * s.half_length,
                 side = std::sqrt(s.radius * s.radius + height * height);
    const double radius = s.radius * height / (s.radius + side); // area over half of the perimeter
    return {{0, 0, radius - s.half_length}, radius};
}
Ball ball_inside(const convex::Ellipsoid& s) {
    return {{}, std::min({s.radii.x, s.radii.y, s.radii.z})};
}

} // namespace

Vec Drawn::farthest_along(Vec n) const {
    return posed.shape.visit([&]<class S>(const S& s) -> Vec {
        if constexpr (requires { farthest(s, n); })
            return farthest(s, n);
        return {}; // is not drawn
    });
}

double Drawn::reach() const {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            Vec n{};
            n[axis] = sign;
            reach = std::max(reach, std::abs(farthest_along(n)[axis]));
        }
    return 2 * reach;
}

Drawn draw_shape(ShapeKind kind, Draws& draws, double thin) {
    Vec lengths{draws.uniform(0.25, 1), draws.uniform(0.25, 1), draws.uniform(0.25, 1)};
    const auto of_three = static_cast<int>(draw_integer(draws, 0, 2)), of_two = of_three % 2;
    const bool has_three =
        kind == ShapeKind::box || kind == ShapeKind::ellipsoid || kind == ShapeKind::hull;
    lengths[kind == ShapeKind::sphere ? 0 : has_three ? of_three : of_two] *= thin;
    Drawn made;
    made.posed.pose = draw_rotation(draws);
    const auto take = [&](const auto& shape) {
        made.posed.shape = shape;
        made.ball = ball_inside(shape);
    };
    switch (kind) {
    case ShapeKind::sphere:
        take(convex::Sphere{lengths.x});
        break;
    case ShapeKind::box:
        take(convex::Box{lengths});
        break;
    case ShapeKind::capsule:
        take(convex::Capsule{lengths.x, lengths.y});
        break;
    case ShapeKind::cylinder:
        take(convex::Cylinder{lengths.x, lengths.y});
        break;
    case ShapeKind::cone:
        take(convex::Cone{lengths.x, lengths.y});
        break;
    case ShapeKind::ellipsoid:
        take(convex::Ellipsoid{lengths});
        break;
    default: {
        static const Polyhedron sphere = geodesic_sphere();
        auto polyhedron = std::make_shared<Polyhedron>(sphere);
        const RigidTransform<double> turn = draw_rotation(draws);
        for (Vec& p : polyhedron->points)
            p = turn({lengths.x * p.x, lengths.y * p.y, lengths.z * p.z});
        made.posed.shape = convex::Hull(polyhedron->points);
        made.posed.polyhedron = std::move(polyhedron);
        made.ball.radius = geodesic_inside * std::min({lengths.x, lengths.y, lengths.z});
    }
    }
    return made;
}

ShapePairCase with_slack(const Drawn& a, const Drawn& b, double lo, double hi) {
    const double size =
        a.reach() + b.reach() + length(a.posed.pose.translation) + length(b.posed.pose.translation);
    return {a.posed, b.posed, lo - slack * size, hi + slack * size};
}

ShapeOfPair scaled(ShapeOfPair posed, int exponent) {
    if (exponent == 0)
        return posed;
    const auto by = [&](double x) { return std::ldexp(x, exponent); };
    posed.pose.translation = boxwood::scaled(posed.pose.translation, exponent);
    posed.shape = posed.shape.visit([&]<class S>(const S& s) -> convex::Shape {
        if constexpr (std::is_same_v<S, convex::Sphere>) {
            return S{by(s.radius)};
        } else if constexpr (std::is_same_v<S, convex::Box>) {
            return S{boxwood::scaled(s.half, exponent)};
        } else if constexpr (std::is_same_v<S, convex::Ellipsoid>) {
            return S{boxwood::scaled(s.radii, exponent)};
        } else if constexpr (requires { s.half_length; }) {
            return S{by(s.radius), by(s.half_length)};
        } else if constexpr (std::is_same_v<S, convex::Hull>) {
            auto polyhedron = std::make_shared<Polyhedron>(*posed.polyhedron);
            for (Vec& p : polyhedron->points)
                p = boxwood::scaled(p, exponent);
            posed.polyhedron = polyhedron;
            return S(polyhedron->points);
        } else {
            return s; // is not drawn
        }
    });
    return posed;
}

ShapeKind draw_kind(Draws& draws) {
    return kinds[static_cast<std::size_t>(draw_integer(draws, 0, std::ssize(kinds) - 1))];
}

HardCaseFamily in_range(HardCaseFamily family) {
    family.scale_max = 20;
    family.scale_min = -20;
    return family;
}

} // namespace boxwood
