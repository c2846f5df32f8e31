#include "scenes/hard_cases/lattice.h"

namespace boxwood {
namespace {

/// A direction with a positive x, so that it isn't zero; of the plane z = 0 if `flat`.
LatticePoint draw_direction(Draws& draws, std::int64_t size, bool flat) {
    const std::int64_t height = flat ? 0 : size;
    return draw_point(draws, {1, -size, -height}, {size, size, height});
}

/// A segment as a triangle: from - m step to + n step, and a corner that is an end or between.
LatticeTriangle segment(Draws& draws, LatticePoint step, std::int64_t from, std::int64_t to) {
    const LatticePoint between = draw_integer(draws, from, to) * step;
    return {from * step, to * step, between};
}

void move(LatticeTriangle& t, LatticePoint by) {
    for (LatticePoint& p : t)
        p = p + by;
}

/// A segment against a triangle or a segment. They share the origin, or a plane is between them.
LatticePair zero_area(Draws& draws, std::int64_t size) {
    const std::int64_t part = size / 4;
    const std::int64_t back = -draw_integer(draws, 0, 2), forth = draw_integer(draws, 1, 2);
    const LatticePoint step = draw_direction(draws, part, draw_coin(draws));
    const LatticePoint flat_step = draw_direction(draws, part, true);
    switch (draw_integer(draws, 0, 6)) {
    case 0: // through the inside of a triangle, or ending there; in its plane every other time
        return {segment(draws, step, back, forth), draw_around_origin(draws, size), Known::yes};
    case 1: { // at a corner of a triangle
        LatticeTriangle corner = draw_hanging(draws, size);
        return {segment(draws, flat_step, back, forth), corner, Known::yes};
    }
    case 2: // two segments that cross or meet
        return {segment(draws, step, back, forth), segment(draws, flat_step, -1, forth),
                Known::yes};
    case 3: // on one line, sharing a piece or an end
        return {segment(draws, step, back, forth), segment(draws, step, 0, 2), Known::yes};
    case 4: // on one line, apart
        return {segment(draws, step, -2, -1), segment(draws, step, back + 2, forth + 2), Known::no};
    case 5: { // above a triangle, z >= 1
        LatticeTriangle above = segment(draws, flat_step, back, forth);
        move(above, {0, 0, draw_coin(draws) ? 1 : draw_integer(draws, 1, size)});
        return {above, draw_around_origin(draws, size), Known::no};
    }
    default: { // beside a triangle in its plane, y >= 1 against y <= 0
        LatticeTriangle beside = segment(draws, {part, 0, 0}, back, forth);
        move(beside, {draw_integer(draws, -part, part), 1, 0});
        return {beside, draw_below_edge(draws, -size, size, size), Known::no};
    }
    }
}

/// A point, or a triangle with two corners the same, against a triangle, a segment or a point.
LatticePair points(Draws& draws, std::int64_t size) {
    const LatticeTriangle origin{};
    LatticeTriangle a = origin;
    if (draw_coin(draws)) // two corners the same, the other anywhere below
        a[2] = draw_point(draws, {-size, -size, -size}, {size, -1, 0});
    LatticeTriangle b = origin;
    switch (draw_integer(draws, 0, 4)) {
    case 0:
        b = draw_around_origin(draws, size);
        break;
    case 1:
        b = mirrored(draw_hanging(draws, size));
        break;
    case 2: {
        const std::int64_t left = -draw_integer(draws, 1, size);
        b = mirrored(draw_below_edge(draws, left, draw_integer(draws, 1, size), size));
        break;
    }
    case 3:
        b = segment(draws, draw_direction(draws, size / 4, true), -1, 2);
        break;
    default: // a point
        break;
    }
    if (draw_coin(draws))
        return {a, b, Known::yes};
    // No longer, once b is moved off the origin: a has z <= 0, b z >= 1. Or within the plane z = 0,
    // where points with y <= 0 are left below points with y >= 1.
    const bool within_plane = draw_coin(draws);
    if (within_plane) {
        a[2].z = 0;
        b = mirrored(draw_hanging(draws, size));
    }
    move(b, within_plane ? LatticePoint{0, 1, 0} : LatticePoint{0, 0, 1});
    return {a, b, Known::no};
}

} // namespace

HardCaseFamily zero_area_triangles_family() {
    return lattice_pair_family<zero_area>(
        "zero_area_triangles", "a triangle that is a segment, against a triangle or a segment",
        Panel::degenerate);
}

HardCaseFamily points_and_duplicates_family() {
    return lattice_pair_family<points>(
        "points_and_duplicates",
        "a triangle that is a point or has a corner twice, against any triangle",
        Panel::degenerate);
}

} // namespace boxwood
