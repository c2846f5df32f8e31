#include "scenes/hard_cases/lattice.h"

#include <algorithm>

namespace boxwood {
namespace {

/// Both hold the origin inside; the second is up to 16 times smaller.
LatticePair overlapping(Draws& draws, std::int64_t size) {
    const auto shrink = static_cast<int>(draw_integer(draws, 0, 4));
    return {draw_around_origin(draws, size),
            draw_around_origin(draws, std::max<std::int64_t>(4, size >> shrink)), Known::yes};
}

/// One in y <= 0, the other in y >= 0, and on y = 0 they share a point or a piece of an edge.
LatticePair touching(Draws& draws, std::int64_t size) {
    const auto length = [&] { return draw_integer(draws, 1, size); };
    const std::int64_t left = -length(), right = length(), other_left = -length(),
                       other_right = length();
    LatticeTriangle a, b;
    switch (draw_integer(draws, 0, 3)) {
    case 0: // corner on corner
        a = draw_hanging(draws, size);
        b = draw_hanging(draws, size);
        break;
    case 1: // corner on edge
        a = draw_below_edge(draws, left, right, size);
        b = draw_hanging(draws, size);
        break;
    case 2: // edge on edge
        a = draw_below_edge(draws, left, right, size);
        b = draw_below_edge(draws, other_left, other_right, size);
        break;
    default: // edges of one line that share an end
        a = draw_below_edge(draws, left, 0, size);
        b = draw_below_edge(draws, 0, right, size);
    }
    return {a, mirrored(b), Known::yes};
}

/// As `touching`, but a lattice unit or more apart, across the line y = 0 or along it.
LatticePair disjoint(Draws& draws, std::int64_t size) {
    const std::int64_t gap = draw_coin(draws) ? 1 : draw_integer(draws, 1, size);
    LatticePair pair{draw_below_edge(draws, -draw_integer(draws, 1, size), 0, size),
                     mirrored(draw_below_edge(draws, 0, draw_integer(draws, 1, size), size)),
                     Known::no};
    if (draw_coin(draws))
        pair.a = draw_hanging(draws, size);
    const LatticePoint away = draw_coin(draws) ? LatticePoint{gap, 0, 0} : LatticePoint{0, gap, 0};
    for (LatticePoint& p : pair.b)
        p = p + away;
    return pair;
}

/// In the planes z = 0 and z = +-1, one above the other.
LatticePair parallel(Draws& draws, std::int64_t size) {
    LatticePair pair{draw_around_origin(draws, size), draw_around_origin(draws, size), Known::no};
    for (LatticePoint& p : pair.b)
        p.z = 1;
    return pair;
}

/// The same triangle again in the next plane, every other time moved aside.
LatticePair copies(Draws& draws, std::int64_t size) {
    const LatticeTriangle a = draw_around_origin(draws, size);
    LatticePair pair{a, a, Known::no};
    LatticePoint away{0, 0, 1};
    if (draw_coin(draws))
        away = draw_point(draws, {-size, -size, 1}, {size, size, 1});
    for (LatticePoint& p : pair.b)
        p = p + away;
    return pair;
}

LatticePair identical(Draws& draws, std::int64_t size) {
    const LatticeTriangle a = draw_around_origin(draws, size);
    return {a, a, Known::yes};
}

} // namespace

HardCaseFamily coplanar_overlapping_family() {
    return lattice_pair_family<overlapping>("coplanar_overlapping",
                                            "triangles of one tilted plane that share an area",
                                            Panel::degenerate);
}

HardCaseFamily coplanar_touching_family() {
    return lattice_pair_family<touching>(
        "coplanar_touching",
        "triangles of one tilted plane that share no more than a corner or a piece of an edge",
        Panel::degenerate);
}

HardCaseFamily coplanar_disjoint_family() {
    return lattice_pair_family<disjoint>(
        "coplanar_disjoint", "triangles of one tilted plane, side by side or on one line, apart",
        Panel::degenerate);
}

HardCaseFamily parallel_planes_family() {
    return lattice_pair_family<parallel>(
        "parallel_planes", "triangles one above the other in planes 2^-k apart", Panel::degenerate);
}

HardCaseFamily translated_copies_family() {
    return lattice_pair_family<copies>(
        "translated_copies", "a triangle and its copy in a plane 2^-k away", Panel::degenerate);
}

HardCaseFamily identical_triangles_family() {
    return lattice_pair_family<identical>("identical_triangles",
                                          "a triangle and itself with its corners permuted",
                                          Panel::degenerate);
}

} // namespace boxwood
