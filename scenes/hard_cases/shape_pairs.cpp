#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace boxwood {
namespace {

using convex::ShapeKind;
using Vec = Vec3<double>;

/// What rounding may move the places that pairs are made from by, of the size of both.
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

/// The transpose of the rotation times v.
Vec rotated_back(const convex::Pose& pose, Vec v) {
    const auto& [x, y, z] = pose.rotation;
    return v.x * x + v.y * y + v.z * z;
}

/// What a pair is made from, in the shape's frame and not by the kernels' functions: its point
/// farthest along n, and a ball inside it.
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

struct Ball {
    Vec centre{};
    double radius = 0;
};
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

/// A shape before it has a place.
struct Drawn {
    ShapeOfPair posed;
    Ball ball;

    Vec farthest_along(Vec n) const {
        return posed.shape.visit([&]<class S>(const S& s) -> Vec {
            if constexpr (requires { farthest(s, n); })
                return farthest(s, n);
            return {}; // is not drawn
        });
    }
    double reach() const {
        double reach = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {-1.0, 1.0}) {
                Vec n{};
                n[axis] = sign;
                reach = std::max(reach, std::abs(farthest_along(n)[axis]));
            }
        return 2 * reach; // at least its length
    }
};

/// `thin`: one of its lengths is so many times smaller.
Drawn draw_shape(ShapeKind kind, Draws& draws, double thin = 1) {
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

/// Where a and b, which has no place yet, are farthest along n and -n, seen from their origins.
struct Facing {
    Vec n, on_a, on_b;

    Facing(const Drawn& a, const Drawn& b, Vec normal)
        : n(normal), on_a(a.posed.pose.rotated(a.farthest_along(rotated_back(a.posed.pose, n)))),
          on_b(b.posed.pose.rotated(b.farthest_along(rotated_back(b.posed.pose, -n)))) {}
};

ShapePairCase with_slack(const Drawn& a, const Drawn& b, double lo, double hi) {
    const double size =
        a.reach() + b.reach() + length(a.posed.pose.translation) + length(b.posed.pose.translation);
    return {a.posed, b.posed, lo - slack * size, hi + slack * size};
}

/// Two convex shapes, each on its side of a slab, that reach its faces at opposite points are as
/// far apart as it is thick.
ShapePairCase apart(Drawn a, Drawn b, Vec n, double gap) {
    const Facing facing(a, b, n);
    b.posed.pose.translation = a.posed.pose.translation + facing.on_a + gap * n - facing.on_b;
    return with_slack(a, b, gap, gap);
}

/// A point of each lies where one of the other does: `share` of the way from its farthest point to
/// the centre of the ball inside it, so that a ball of `share` of its radius is inside, too. The
/// depth is at least share * (both radii), and at most both ways inwards along n.
ShapePairCase overlapping(Drawn a, Drawn b, Vec n, double share) {
    const Facing facing(a, b, n);
    const Vec centre_a = a.posed.pose.rotated(a.ball.centre),
              centre_b = b.posed.pose.rotated(b.ball.centre);
    const Vec inwards_a = share * (centre_a - facing.on_a),
              inwards_b = share * (centre_b - facing.on_b);
    b.posed.pose.translation =
        a.posed.pose.translation + (facing.on_a + inwards_a) - (facing.on_b + inwards_b);
    return with_slack(a, b, -dot(inwards_b - inwards_a, n),
                      -share * (a.ball.radius + b.ball.radius));
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

template <class Draw>
Cases shape_pairs(const HardCaseSpec& spec, const Random& random, const Draw& draw) {
    std::vector<ShapePairCase> cases(spec.n);
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        const ShapePairCase pair = draw(draws);
        cases[i] = {scaled(pair.a, spec.scale), scaled(pair.b, spec.scale),
                    std::ldexp(pair.lo, spec.scale), std::ldexp(pair.hi, spec.scale)};
    }
    return cases;
}

/// Of the kinds a and b, up to 1 apart or, `percent` of them, overlapping.
ShapePairCase generic(ShapeKind kind_a, ShapeKind kind_b, Draws& draws, int percent) {
    Drawn a = draw_shape(kind_a, draws);
    const Drawn b = draw_shape(kind_b, draws);
    a.posed.pose.translation = draw_offset(draws);
    const Vec n = draws.unit_vector();
    const bool overlap = draws.uniform(0, 100) < percent;
    return overlap ? overlapping(a, b, n, draws.uniform(0.01, 1))
                   : apart(a, b, n, draws.uniform(0.01, 1));
}
template <ShapeKind a, ShapeKind b>
HardCaseFamily pair_family(std::string_view name, std::string_view summary) {
    HardCaseFamily family =
        with_k(rounded_family(name, summary, Panel::generic,
                              [](const HardCaseSpec& spec, const Random& random) {
                                  return shape_pairs(spec, random, [&](Draws& draws) {
                                      return generic(a, b, draws, *spec.k);
                                  });
                              }),
               "per cent of the pairs that overlap", 50, 0, 100);
    family.scale_min = family.scale_max = 0; // the mixed families below have scales
    return family;
}

ShapeKind draw_kind(Draws& draws) {
    return kinds[static_cast<std::size_t>(draw_integer(draws, 0, std::ssize(kinds) - 1))];
}

/// At least 2^-(k+1) apart, or by such a share in each other; half of each.
ShapePairCase nearly_touching(Draws& draws, int k) {
    const ShapeKind kind_a = draw_kind(draws), kind_b = draw_kind(draws);
    Drawn a = draw_shape(kind_a, draws);
    const Drawn b = draw_shape(kind_b, draws);
    a.posed.pose.translation = draw_offset(draws);
    const Vec n = draws.unit_vector();
    const auto exponent = static_cast<int>(draw_integer(draws, 1, k));
    const double by = std::ldexp(draws.uniform(0.5, 1), -exponent);
    return draw_coin(draws) ? apart(a, b, n, by) : overlapping(a, b, n, by);
}

/// One length of each 10^-k of the others (of a sphere its radius), up to 1 apart or overlapping.
ShapePairCase thin_pair(Draws& draws, int k) {
    const ShapeKind kind_a = draw_kind(draws), kind_b = draw_kind(draws);
    Drawn a = draw_shape(kind_a, draws, power_of_ten(-k));
    const Drawn b = draw_shape(kind_b, draws, power_of_ten(-k));
    a.posed.pose.translation = draw_offset(draws);
    const Vec n = draws.unit_vector();
    const double by = draws.uniform(0.01, 1);
    return draw_coin(draws) ? apart(a, b, n, by) : overlapping(a, b, n, by);
}

/// Scales where rounding is below the 1e-6 at which libraries end, whatever the size: beyond them
/// FCL's expanding polytope never ends.
HardCaseFamily in_range(HardCaseFamily family) {
    family.scale_max = 20;
    family.scale_min = -20;
    return family;
}

template <ShapePairCase (*draw)(Draws&, int)>
HardCaseFamily mixed_family(std::string_view name, std::string_view summary, Panel panel) {
    HardCaseFamily family =
        rounded_family(name, summary, panel, [](const HardCaseSpec& spec, const Random& random) {
            return shape_pairs(spec, random, [&](Draws& draws) { return draw(draws, *spec.k); });
        });
    return in_range(family);
}

} // namespace

#define BOXWOOD_PAIR(a, b, summary)                                                                \
    HardCaseFamily a##_and_##b##_family() {                                                        \
        return pair_family<ShapeKind::a, ShapeKind::b>(#a "_and_" #b,                              \
                                                       summary ", apart or overlapping");          \
    }
BOXWOOD_PAIR(sphere, sphere, "a sphere and a sphere")
BOXWOOD_PAIR(sphere, box, "a sphere and a box")
BOXWOOD_PAIR(sphere, capsule, "a sphere and a capsule")
BOXWOOD_PAIR(sphere, cylinder, "a sphere and a cylinder")
BOXWOOD_PAIR(sphere, cone, "a sphere and a cone")
BOXWOOD_PAIR(sphere, ellipsoid, "a sphere and an ellipsoid")
BOXWOOD_PAIR(sphere, hull, "a sphere and a hull")
BOXWOOD_PAIR(box, box, "a box and a box")
BOXWOOD_PAIR(box, capsule, "a box and a capsule")
BOXWOOD_PAIR(box, cylinder, "a box and a cylinder")
BOXWOOD_PAIR(box, cone, "a box and a cone")
BOXWOOD_PAIR(box, ellipsoid, "a box and an ellipsoid")
BOXWOOD_PAIR(box, hull, "a box and a hull")
BOXWOOD_PAIR(capsule, capsule, "a capsule and a capsule")
BOXWOOD_PAIR(capsule, cylinder, "a capsule and a cylinder")
BOXWOOD_PAIR(capsule, cone, "a capsule and a cone")
BOXWOOD_PAIR(capsule, ellipsoid, "a capsule and an ellipsoid")
BOXWOOD_PAIR(capsule, hull, "a capsule and a hull")
BOXWOOD_PAIR(cylinder, cylinder, "a cylinder and a cylinder")
BOXWOOD_PAIR(cylinder, cone, "a cylinder and a cone")
BOXWOOD_PAIR(cylinder, ellipsoid, "a cylinder and an ellipsoid")
BOXWOOD_PAIR(cylinder, hull, "a cylinder and a hull")
BOXWOOD_PAIR(cone, cone, "a cone and a cone")
BOXWOOD_PAIR(cone, ellipsoid, "a cone and an ellipsoid")
BOXWOOD_PAIR(cone, hull, "a cone and a hull")
BOXWOOD_PAIR(ellipsoid, ellipsoid, "an ellipsoid and an ellipsoid")
BOXWOOD_PAIR(ellipsoid, hull, "an ellipsoid and a hull")
BOXWOOD_PAIR(hull, hull, "a hull and a hull")
#undef BOXWOOD_PAIR

HardCaseFamily nearly_touching_shapes_family() {
    return with_k(mixed_family<nearly_touching>(
                      "nearly_touching_shapes",
                      "convex shapes of all kinds that nearly touch or just overlap",
                      Panel::touching),
                  "the gap, or the share that is deep, is 2^-(k+1) at least", 30, 1, 36);
}

HardCaseFamily thin_shapes_family() {
    return with_k(mixed_family<thin_pair>(
                      "thin_shapes",
                      "flat and needle-like convex shapes of all kinds, apart or overlapping",
                      Panel::degenerate),
                  "one length is 10^-k of the others", 3, 0, 6);
}

} // namespace boxwood
