#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

namespace boxwood {
namespace {

using Vec = Vec3<double>;

/// Long 10^k and 10^-k wide.
Triangle<double> draw_sliver(Draws& draws, int k) {
    const double reach = power_of_ten(k), width = draw_small(draws, k);
    const double left = -draws.uniform(0.5, 1), right = draws.uniform(0.5, 1);
    const double between = draws.uniform(left, right);
    return {{left * reach, 0, 0}, {right * reach, 0, 0}, {between * reach, width, 0}};
}

/// Two long edges and one of 10^-k.
Triangle<double> draw_needle(Draws& draws, int k) {
    const double width = draw_small(draws, k);
    const double left = -draws.uniform(0.5, 1), right = draws.uniform(0.5, 1);
    const double aside = draws.uniform(-1, 1) * width;
    return {{left, 0, 0}, {right, 0, 0}, {right + aside, width, 0}};
}

/// An obtuse triangle 10^-k high.
Triangle<double> draw_cap(Draws& draws, int k) {
    const double height = draw_small(draws, k);
    const double left = -draws.uniform(0.5, 1), right = draws.uniform(0.5, 1);
    return {{left, 0, 0}, {right, 0, 0}, {draws.uniform(-0.25, 0.25), height, 0}};
}

/// Two of them, turned any way and put so that a point of each coincide, or miss by about their
/// width; or every fourth time in one plane.
template <Triangle<double> (*shape)(Draws&, int)> TrianglePairCase crossing(Draws& draws, int k) {
    TrianglePairCase pair;
    const RigidTransform<double> turn = draw_rotation(draws);
    pair.a = turn * shape(draws, k);
    const bool one_plane = draw_integer(draws, 0, 3) == 0;
    const RigidTransform<double> other_turn = one_plane ? turn : draw_rotation(draws);
    pair.b = other_turn * shape(draws, k);
    const Vec on_a = draw_inside(pair.a, draws), on_b = draw_inside(pair.b, draws);
    const double miss = draw_coin(draws) ? 0 : draw_small(draws, k);
    pair.b = pair.b + (on_a - on_b + miss * draws.in_ball());
    return pair;
}

} // namespace

HardCaseFamily slivers_family() {
    return with_k(rounded_family("slivers",
                                 "triangles 10^k long and 10^-k wide, crossing or nearly so",
                                 Panel::degenerate, rounded_pairs<crossing<draw_sliver>>),
                  "length 10^k, width 10^-k", 3, 1, 8);
}

HardCaseFamily needle_triangles_family() {
    return with_k(rounded_family("needle_triangles",
                                 "triangles with one edge of 10^-k, crossing or nearly so",
                                 Panel::degenerate, rounded_pairs<crossing<draw_needle>>),
                  "the short edge is 10^-k", 6, 1, 15);
}

HardCaseFamily cap_triangles_family() {
    return with_k(rounded_family("cap_triangles",
                                 "obtuse triangles 10^-k high, crossing or nearly so",
                                 Panel::degenerate, rounded_pairs<crossing<draw_cap>>),
                  "the height is 10^-k", 6, 1, 15);
}

} // namespace boxwood
