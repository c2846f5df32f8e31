/// Numbers so far from one another that no fixed number of bits holds them all: what exact kernels
/// fall back on where narrower numbers do not do.

#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace boxwood {
namespace {

using Vec = Vec3<double>;
using Corners = std::array<Vec, 6>;

/// Integers from -4 to 4, so that there are ties, and zeros, among them.
Vec draw_small_integers(Draws& draws) { return Vec(draw_point(draws, {-4, -4, -4}, {4, 4, 4})); }

/// Integers times 1 and two powers of two down to 2^-k, one of them for each number, each corner,
/// or, as a whole, each triangle.
Corners draw_corners(Draws& draws, int k) {
    const int lowest = k >> (2 * draw_integer(draws, 0, 2));
    const std::array<int, 3> octaves{0, -static_cast<int>(draw_integer(draws, 0, lowest)), -lowest};
    const auto draw_octave = [&] {
        return octaves[static_cast<std::size_t>(draw_integer(draws, 0, 2))];
    };
    const std::int64_t each = draw_integer(draws, 0, 3);
    Corners corners;
    int octave = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = draw_small_integers(draws);
        for (int axis = 0; axis < 3; ++axis) {
            if (each <= 1 || (axis == 0 && (each == 2 || i % 3 == 0)))
                octave = draw_octave();
            corners[i][axis] = std::ldexp(corners[i][axis], octave);
        }
    }
    return corners;
}

TrianglePairCase pair_of(const Corners& p) { return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}}; }

TrianglePairCase mixed_in_space(Draws& draws, int k) { return pair_of(draw_corners(draws, k)); }

/// In the plane z = 0 or z = x, the axes exchanged.
TrianglePairCase mixed_in_plane(Draws& draws, int k) {
    Corners corners = draw_corners(draws, k);
    const bool is_tilted = draw_coin(draws);
    const std::int64_t turns = draw_integer(draws, 0, 2);
    for (Vec& p : corners) {
        p.z = is_tilted ? p.x : 0;
        for (std::int64_t i = 0; i < turns; ++i)
            p = {p.z, p.x, p.y};
    }
    return pair_of(corners);
}

/// Scales: integers of 3 bits, times 2^-k at least.
HardCaseFamily mixed_family(std::string_view name, std::string_view summary,
                            decltype(HardCaseFamily::generate) generate) {
    HardCaseFamily family = with_k(rounded_family(name, summary, Panel::degenerate, generate),
                                   "powers of two down to 2^-k", 1074, 0, 1074);
    family.scale_min = 0;
    family.scale_max = 1000;
    return family;
}

} // namespace

HardCaseFamily mixed_octaves_family() {
    return mixed_family("mixed_octaves",
                        "small integers times powers of two that differ by number or by corner",
                        rounded_pairs<mixed_in_space>);
}

HardCaseFamily coplanar_mixed_octaves_family() {
    return mixed_family("coplanar_mixed_octaves", "the same in one plane",
                        rounded_pairs<mixed_in_plane>);
}

} // namespace boxwood
