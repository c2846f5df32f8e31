#include "scenes/hard_cases/drawn_shapes.h"
#include "scenes/hard_cases/lattice.h"

namespace boxwood {
namespace {

using convex::ShapeKind;
using Vec = Vec3<double>;

/// The transpose of the rotation times v.
Vec rotated_back(const convex::Pose& pose, Vec v) {
    const auto& [x, y, z] = pose.rotation;
    return v.x * x + v.y * y + v.z * z;
}

/// Where a and b, which has no place yet, are farthest along n and -n, seen from their origins.
struct Facing {
    Vec n, on_a, on_b;

    Facing(const Drawn& a, const Drawn& b, Vec normal)
        : n(normal), on_a(a.posed.pose.rotated(a.farthest_along(rotated_back(a.posed.pose, n)))),
          on_b(b.posed.pose.rotated(b.farthest_along(rotated_back(b.posed.pose, -n)))) {}
};

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
std::string share_of_overlaps(int percent) {
    return percent == 0     ? "apart"
           : percent == 100 ? "overlapping"
                            : std::to_string(percent) + " % of them overlap";
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
    family.k_words = share_of_overlaps;
    family.scale_min = family.scale_max = 0; // the mixed families below have scales
    return family;
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
