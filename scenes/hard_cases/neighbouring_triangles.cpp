#include "scenes/hard_cases/lattice.h"

namespace boxwood {
namespace {

/// A point of z < 0 left or right of the plane x = 0.
LatticePoint draw_deep(Draws& draws, std::int64_t size, bool left) {
    return draw_point(draws, {left ? -size : 0, -size, -size}, {left ? -1 : size, size, -1});
}

/// A corner at the origin, the rest below z = 0; never degenerate.
LatticeTriangle draw_hanging_in_space(Draws& draws, std::int64_t size) {
    return {LatticePoint{}, draw_deep(draws, size, true), draw_deep(draws, size, false)};
}

LatticeTriangle upside_down(LatticeTriangle t) {
    for (LatticePoint& p : t)
        p.z = -p.z;
    return t;
}

/// The plane z = 0 keeps them apart but for the origin.
LatticePair share_vertex(Draws& draws, std::int64_t size) {
    return {draw_hanging_in_space(draws, size), upside_down(draw_hanging_in_space(draws, size)),
            Known::yes};
}

/// On two sides of z = 0, or every fourth time of y = 0 in one plane, but for the edge.
LatticePair share_edge(Draws& draws, std::int64_t size) {
    const std::int64_t length = draw_integer(draws, 1, size);
    if (draw_integer(draws, 0, 3) == 0)
        return {draw_below_edge(draws, 0, length, size),
                mirrored(draw_below_edge(draws, 0, length, size)), Known::yes};
    LatticeTriangle a{LatticePoint{}, LatticePoint{length, 0, 0},
                      draw_deep(draws, size, draw_coin(draws))};
    LatticeTriangle b = a;
    b[2] = draw_deep(draws, size, draw_coin(draws));
    return {a, upside_down(b), Known::yes};
}

/// z <= -1 against z >= 1.
LatticePair separated(Draws& draws, std::int64_t size) {
    const auto below = [&] {
        const auto low = [&] { return draw_point(draws, {-size, -size, -size}, {size, size, -1}); };
        return LatticeTriangle{low(), low(), low()};
    };
    const LatticeTriangle a = below();
    return {a, upside_down(below()), Known::no};
}

} // namespace

HardCaseFamily shared_vertex_family() {
    return lattice_pair_family<share_vertex>(
        "shared_vertex", "triangles that share a corner and nothing else", Panel::touching);
}

HardCaseFamily shared_edge_family() {
    return lattice_pair_family<share_edge>(
        "shared_edge", "triangles that share an edge and nothing else, some in one plane",
        Panel::touching);
}

HardCaseFamily separated_triangles_family() {
    return lattice_pair_family<separated>("separated_triangles",
                                          "triangles on the two sides of a plane", Panel::generic);
}

} // namespace boxwood
