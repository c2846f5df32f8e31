#include "scenes/hard_cases/lattice.h"

#include <algorithm>

namespace boxwood {
namespace {

// A vertex and the corners of a face, or the ends of two edges. Where a comment says y <= 0, it
// holds at the start and at the end and so, the motion being linear, all the time.

using LatticeFour = std::array<LatticePoint, 4>;

LatticePoint draw_flat_point(Draws& draws, std::int64_t size) {
    return draw_point(draws, {-size, -size, 0}, {size, size, 0});
}

/// The vertex at the origin, which lies inside the face or, every other time, on its edge or
/// corner.
LatticeFour touching_vertex_face(Draws& draws, std::int64_t size) {
    LatticeTriangle face;
    if (draw_coin(draws)) {
        face = draw_around_origin(draws, size);
    } else if (draw_coin(draws)) {
        face = draw_hanging(draws, size);
    } else {
        const std::int64_t left = -draw_integer(draws, 1, size);
        face = draw_below_edge(draws, left, draw_integer(draws, 1, size), size);
    }
    return {LatticePoint{}, face[0], face[1], face[2]};
}

/// Edges that cross at the origin, or meet there with one end or both.
LatticeFour touching_edge_edge(Draws& draws, std::int64_t size) {
    const LatticePoint step = draw_point(draws, {-size / 2, 1, 0}, {size / 2, size / 2, 0});
    const std::int64_t back = draw_integer(draws, 0, 2), forth = draw_integer(draws, 1, 2);
    const std::int64_t left = draw_coin(draws) ? 0 : -draw_integer(draws, 1, size);
    const std::int64_t right = draw_integer(draws, 1, size);
    return {LatticePoint{left, 0, 0}, LatticePoint{right, 0, 0}, -back * step, forth * step};
}

template <MotionKind kind> constexpr auto touching_now = touching_vertex_face;
template <> constexpr auto touching_now<MotionKind::edge_edge> = touching_edge_edge;

/// The points of the upper one: the vertex, or the second edge.
template <MotionKind kind>
constexpr std::array<bool, 4> upper =
    kind == MotionKind::vertex_face ? std::array{true, false, false, false}
                                    : std::array{false, false, true, true};

/// Touching at the start, and later apart: z >= 1 above z <= 0. Half of them start one lattice unit
/// further up and never touch.
template <MotionKind kind> LatticeMotion at_ends(Draws& draws, std::int64_t size) {
    LatticeMotion motion{touching_now<kind>(draws, size), {}, Known::yes};
    if (draw_coin(draws)) {
        motion.touch = Known::no;
        for (std::size_t p = 0; p < 4; ++p)
            motion.start[p].z += upper<kind>[p];
    }
    for (std::size_t p = 0; p < 4; ++p)
        motion.end[p] = upper<kind>[p] ? draw_point(draws, {-size, -size, 1}, {size, size, size})
                                       : draw_point(draws, {-size, -size, -size}, {size, size, 0});
    return motion;
}

/// No motion but the common one: touching, one lattice unit above, or apart within one plane.
template <MotionKind kind> LatticeMotion still(Draws& draws, std::int64_t size) {
    LatticeMotion motion{touching_now<kind>(draws, size), {}, Known::yes};
    switch (draw_integer(draws, 0, 3)) {
    case 0:
        motion.touch = Known::no;
        for (std::size_t p = 0; p < 4; ++p)
            motion.start[p].z += upper<kind>[p];
        break;
    case 1:
        motion.touch = Known::no;
        for (std::size_t p = 0; p < 4; ++p)
            motion.start[p] = upper<kind>[p] ? draw_point(draws, {-size, 1, 0}, {size, size, 0})
                                             : draw_point(draws, {-size, -size, 0}, {size, 0, 0});
        break;
    default:
        break;
    }
    motion.end = motion.start;
    return motion;
}

/// All in the plane z = 0 from start to end: the coplanarity cubic is 0. Touching at the end;
/// passing through without touching at either end; or kept apart by a line.
LatticeMotion coplanar_vertex_face(Draws& draws, std::int64_t size) {
    LatticeMotion motion{{}, touching_vertex_face(draws, size), Known::yes};
    switch (draw_integer(draws, 0, 3)) {
    case 0:
        for (LatticePoint& p : motion.start)
            p = draw_flat_point(draws, size);
        break;
    case 1: { // from far on one side through the origin to far on the other, the face at rest
        motion.start = motion.end;
        const LatticePoint step = draw_point(draws, {1, -size, 0}, {size, size, 0});
        motion.start[0] = -draw_integer(draws, 1, 4) * step;
        motion.end[0] = draw_integer(draws, 1, 4) * step;
        break;
    }
    case 2: { // along y = 0 past the tip of a face of y <= 0, which is at the origin
        const LatticeTriangle face = draw_hanging(draws, size);
        motion.start = {LatticePoint{-draw_integer(draws, 1, 4 * size), 0, 0}, face[0], face[1],
                        face[2]};
        motion.end = motion.start;
        motion.end[0].x = draw_integer(draws, 1, 4 * size);
        break;
    }
    default: // y >= 1 against y <= 0
        motion.touch = Known::no;
        for (LatticeFour* points : {&motion.start, &motion.end})
            for (std::size_t p = 0; p < 4; ++p)
                (*points)[p] = p == 0 ? draw_point(draws, {-size, 1, 0}, {size, size, 0})
                                      : draw_point(draws, {-size, -size, 0}, {size, 0, 0});
    }
    return motion;
}

LatticeMotion coplanar_edge_edge(Draws& draws, std::int64_t size) {
    LatticeMotion motion{{}, touching_edge_edge(draws, size), Known::yes};
    const auto on_line = [](std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
        return LatticeFour{LatticePoint{a, 0, 0}, LatticePoint{b, 0, 0}, LatticePoint{c, 0, 0},
                           LatticePoint{d, 0, 0}};
    };
    const auto length = [&] { return draw_integer(draws, 1, size); };
    switch (draw_integer(draws, 0, 4)) {
    case 0:
        for (LatticePoint& p : motion.start)
            p = draw_flat_point(draws, size);
        break;
    case 1: { // the second edge is swept through the origin, at rest in the first
        const LatticePoint away = draw_flat_point(draws, size);
        motion.start = motion.end;
        for (const std::size_t p : {2u, 3u}) {
            motion.start[p] = motion.start[p] - away;
            motion.end[p] = motion.end[p] + away;
        }
        break;
    }
    case 2: { // on one line, meeting on the way
        const std::int64_t a = length(), b = length(), gap = length();
        motion.start = on_line(-a, 0, gap, gap + b);
        motion.end = on_line(-a, 0, -gap, -gap + b);
        break;
    }
    case 3: { // on one line, the second running from 1 or more away to 1 or more away
        const std::int64_t a = length(), b = length(), gap = length(), other = length();
        motion.touch = Known::no;
        motion.start = on_line(-a, 0, gap, gap + b);
        motion.end = on_line(-a, 0, draw_coin(draws) ? 1 : other, other + b);
        break;
    }
    default: // y >= 1 against y <= 0
        motion.touch = Known::no;
        for (LatticeFour* points : {&motion.start, &motion.end})
            for (std::size_t p = 0; p < 4; ++p)
                (*points)[p] = p >= 2 ? draw_point(draws, {-size, 1, 0}, {size, size, 0})
                                      : draw_point(draws, {-size, -size, 0}, {size, 0, 0});
    }
    return motion;
}

/// With s from -p at t = 0 to q at t = 1: three points span a plane that rolls about the x axis by
/// 4 A s over a length of 4 Y, while the fourth meets it at height A s + d and y = Y - B s. Their
/// determinant is 4 A B s^2 + 4 Y d times an edge along x, which may grow, so that there is a third
/// root: a double root at s = 0, t = p / (p + q), for d = 0, none for d = 1, and two simple ones
/// near it, mostly irrational, for d = -1. There (B s)^2 = B Y / A <= Y^2 / 4, as A Y >= 4 B:
/// A >= size / 6, Y >= size / 8, B <= size / 4 and size >= 64.
struct Rolling {
    std::int64_t a, b, y, lift, p, q, growth;
    Known touch;
};
Rolling draw_rolling(Draws& draws, std::int64_t size) {
    Rolling roll{};
    roll.p = draw_integer(draws, 1, 3);
    roll.q = draw_integer(draws, 1, 3);
    const std::int64_t farther = std::max(roll.p, roll.q);
    roll.a = draw_integer(draws, (size + 2 * farther - 1) / (2 * farther), size / farther);
    roll.b = draw_integer(draws, size / 8, size / 4);
    roll.y = draw_integer(draws, size / 8, size / 4);
    roll.growth = draw_coin(draws) ? 0 : draw_integer(draws, 1, size / 6);
    roll.lift = draw_integer(draws, -1, 1);
    roll.touch = roll.lift == 1 ? Known::no : Known::yes;
    return roll;
}

/// They touch at u <= 1/2 and v = 1/4, or with lift = -1 at v from 1/8 to 3/8.
LatticeMotion tangential_vertex_face(Draws& draws, std::int64_t size) {
    const Rolling r = draw_rolling(draws, size);
    const std::int64_t x = draw_integer(draws, 1, size);
    const std::int64_t width = 2 * x + draw_integer(draws, 0, size);
    const auto at = [&](std::int64_t s) {
        return LatticeFour{LatticePoint{x, r.y - r.b * s, r.a * s + r.lift}, LatticePoint{},
                           LatticePoint{width + r.growth * (s + r.p), 0, 0},
                           LatticePoint{0, 4 * r.y, 4 * r.a * s}};
    };
    return {at(-r.p), at(r.q), r.touch};
}

/// The first edge along the x axis; the second crosses it at a quarter of its length.
LatticeMotion tangential_edge_edge(Draws& draws, std::int64_t size) {
    const Rolling r = draw_rolling(draws, size);
    const std::int64_t x = draw_integer(draws, -size / 4, size / 4);
    const std::int64_t imbalance = draw_integer(draws, -size / 8, size / 8);
    const std::int64_t left = -draw_integer(draws, size, 2 * size);
    const std::int64_t right = draw_integer(draws, size, 2 * size);
    const auto at = [&](std::int64_t s) {
        return LatticeFour{
            LatticePoint{left, 0, 0}, LatticePoint{right + r.growth * (s + r.p), 0, 0},
            LatticePoint{x - imbalance, -r.y - r.b * s, -r.a * s + r.lift},
            LatticePoint{x + 3 * imbalance, 3 * r.y - r.b * s, 3 * r.a * s + r.lift}};
    };
    return {at(-r.p), at(r.q), r.touch};
}

} // namespace

#define BOXWOOD_MOTIONS(kind, word)                                                                \
    HardCaseFamily touch_at_ends_##kind##_family() {                                               \
        return lattice_motion_family<MotionKind::kind, at_ends<MotionKind::kind>>(                 \
            "touch_at_ends_" #kind,                                                                \
            word ", touching exactly at t = 0 or t = 1, or 2^-k short of it", Panel::touching);    \
    }                                                                                              \
    HardCaseFamily still_##kind##_family() {                                                       \
        return lattice_motion_family<MotionKind::kind, still<MotionKind::kind>>(                   \
            "still_" #kind, word ", without relative motion, touching or apart",                   \
            Panel::degenerate);                                                                    \
    }                                                                                              \
    HardCaseFamily tangential_##kind##_family() {                                                  \
        return lattice_motion_family<MotionKind::kind, tangential_##kind>(                         \
            "tangential_" #kind,                                                                   \
            word ", at a double root of the coplanarity cubic, or 2^-k to either side of it",      \
            Panel::touching);                                                                      \
    }                                                                                              \
    HardCaseFamily coplanar_##kind##_family() {                                                    \
        return lattice_motion_family<MotionKind::kind, coplanar_##kind>(                           \
            "coplanar_" #kind, word ", in one plane through the whole step", Panel::degenerate);   \
    }

BOXWOOD_MOTIONS(vertex_face, "a vertex and a face")
BOXWOOD_MOTIONS(edge_edge, "two edges")
#undef BOXWOOD_MOTIONS

} // namespace boxwood
