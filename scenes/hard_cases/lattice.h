#pragma once

#include "scenes/hard_cases/hard_cases.h"
#include "scenes/sampling/random.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace boxwood {

/// A point with integer coordinates. A configuration of integers whose truth is plain to see keeps
/// it under an integer map of determinant +-1, and as doubles: truth by construction.
using LatticePoint = Vec3<std::int64_t>;
using LatticeTriangle = std::array<LatticePoint, 3>;

/// Uniform in low .. high, both included, less than 2^53 numbers.
std::int64_t draw_integer(Draws& draws, std::int64_t low, std::int64_t high);

/// True every other time, with no pattern.
inline bool draw_coin(Draws& draws) { return draws.word() >> 31 != 0; }

/// Uniform in the closed box, z = 0 if its bounds are.
LatticePoint draw_point(Draws& draws, LatticePoint low, LatticePoint high);

template <class T, std::size_t n> void shuffle(std::array<T, n>& array, Draws& draws) {
    for (std::size_t i = n; i > 1; --i)
        std::swap(array[i - 1], array[static_cast<std::size_t>(
                                    draw_integer(draws, 0, static_cast<std::int64_t>(i) - 1))]);
}

/// x -> M x.
struct LatticeMap {
    std::array<LatticePoint, 3> rows;

    LatticePoint operator()(LatticePoint p) const {
        return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)};
    }
};

/// A matrix of determinant +-1: P L U Q with signed permutations P, Q and unit triangular L, U,
/// whose entries off the diagonal are at most s = `steepness`. |M x| <= (3 s^2 + 2 s + 1) max|x|.
LatticeMap draw_tilt(Draws& draws, int steepness);

/// p 2^exponent; exact while p has at most 53 bits and exponent >= -1074.
inline Vec3<double> to_scene(LatticePoint p, int exponent) {
    const auto x = static_cast<Vec3<double>>(p);
    return {std::ldexp(x.x, exponent), std::ldexp(x.y, exponent), std::ldexp(x.z, exponent)};
}

/// Triangles of the plane z = 0, never degenerate, |coordinate| <= size, size >= 4:
/// with the origin inside;
LatticeTriangle draw_around_origin(Draws& draws, std::int64_t size);
/// with one corner at the origin and the others at y < 0;
LatticeTriangle draw_hanging(Draws& draws, std::int64_t size);
/// with the edge from (left, 0) to (right, 0), left < right, and a corner at y < 0.
LatticeTriangle draw_below_edge(Draws& draws, std::int64_t left, std::int64_t right,
                                std::int64_t size);

/// The mirror image in y = 0.
LatticeTriangle mirrored(LatticeTriangle t);

/// What the families of the lattice draw, with size = 2^k and |coordinate| <= 4 size. Then pairs
/// and motions are shifted (motions along with a velocity) and tilted, their corners and sides
/// exchanged, and scaled to size 2^scale.
struct LatticePair {
    LatticeTriangle a, b;
    Known touch;
};
using DrawLatticePair = LatticePair (*)(Draws& draws, std::int64_t size);
Cases lattice_pairs(const HardCaseSpec& spec, const Random& random, DrawLatticePair draw);

struct LatticeMotion {
    std::array<LatticePoint, 4> start, end;
    Known touch;
};
using DrawLatticeMotion = LatticeMotion (*)(Draws& draws, std::int64_t size);
/// Also run backwards every other time: t becomes 1 - t.
Cases lattice_motions(const HardCaseSpec& spec, const Random& random, MotionKind kind,
                      DrawLatticeMotion draw);

/// The rows of their families.
HardCaseFamily lattice_family(std::string_view name, std::string_view summary, Panel panel,
                              decltype(HardCaseFamily::generate) generate);
template <DrawLatticePair draw>
HardCaseFamily lattice_pair_family(std::string_view name, std::string_view summary, Panel panel) {
    return lattice_family(name, summary, panel, [](const HardCaseSpec& spec, const Random& random) {
        return lattice_pairs(spec, random, draw);
    });
}
template <MotionKind kind, DrawLatticeMotion draw>
HardCaseFamily lattice_motion_family(std::string_view name, std::string_view summary, Panel panel) {
    return lattice_family(name, summary, panel, [](const HardCaseSpec& spec, const Random& random) {
        return lattice_motions(spec, random, kind, draw);
    });
}

} // namespace boxwood
