#pragma once

#include "kernels/decision.h"
#include "kernels/triangle_triangle/detail/flat.h"

#include <array>
#include <cstdint>

namespace boxwood::detail {

/// The interval test of two triangles, from nothing but signs of orientation determinants: 6 that
/// place each triangle's corners against the other's plane, then 2 that compare the intervals which
/// the triangles cut out of the planes' common line. Coplanar and degenerate pairs go to FlatPair.
/// As right as the signs; `maybe` where one that matters is undecided. Source: Guigue, Devillers
/// 2003, "Fast and Robust Triangle-Triangle Overlap Test Using Orientation Predicates".
template <PairSigns S> class IntervalTest {
  public:
    BOXWOOD_BOTH static Answer meet(S& signs) {
        Sides of_b = signs.sides(0), of_a = signs.sides(1);
        if (Sides::one_strictly_one_side(of_a, of_b))
            return Answer::no;
        if ((of_a.unknown() | of_b.unknown()) != 0) {
            of_b = signs.decided_sides(0);
            if (of_b.strictly_one_side())
                return Answer::no;
            if (of_b.all_on_plane()) // of_a may stay unknown
                return FlatPair<S>::meet(signs);
            of_a = signs.decided_sides(1);
            if (of_a.strictly_one_side())
                return Answer::no;
            if ((of_a.unknown() | of_b.unknown()) != 0)
                return Answer::maybe;
        }
        // Coplanar, or one of them has no plane.
        if (of_b.all_on_plane() || of_a.all_on_plane())
            return FlatPair<S>::meet(signs);

        // Turned so that each lone corner lies on the positive side of the other's plane, the
        // common line leaves a between q1 and r1, and b between q2 and r2.
        const Lone la = lone(of_a), lb = lone(of_b);
        return signs.overlap_along_line(from(0, la.corner, lb.sign), from(3, lb.corner, la.sign));
    }

  private:
    /// The corner that a plane parts from the other two: it lies on side `sign` (or on the plane,
    /// and the others strictly on the other side); the others on side -sign or on the plane.
    struct Lone {
        std::uint8_t corner;
        std::int8_t sign;
    };

    /// Of the sides that are neither all equal and strict nor all on the plane:
    /// one corner above -> it; else one below -> it; else (0, +, +) or (0, -, -) -> the zero.
    BOXWOOD_BOTH static constexpr Lone lone_by_case(unsigned above, unsigned below) {
        const unsigned on_plane = 7 & ~(above | below);
        const bool one_above = is_one(above), one_below = is_one(below);
        const unsigned alone = one_above ? above : one_below ? below : on_plane;
        const bool positive = one_above || (!one_below && above == 0);
        const std::uint8_t corner = (alone & 1) != 0 ? 0 : (alone & 2) != 0 ? 1 : 2;
        return {corner, static_cast<std::int8_t>(positive ? 1 : -1)};
    }
    BOXWOOD_BOTH static constexpr bool is_one(unsigned corners) {
        return corners == 1 || corners == 2 || corners == 4;
    }

    static constexpr std::array<Lone, 64> lone_of = [] {
        std::array<Lone, 64> table{};
        for (unsigned above = 0; above < 8; ++above)
            for (unsigned below = 0; below < 8; ++below)
                table[above | below << 3] = lone_by_case(above, below);
        return table;
    }();
    static constexpr std::array<std::uint8_t, 5> corner_around{0, 1, 2, 0, 1};

    // A device does without the tables, which it would read from memory.
    BOXWOOD_BOTH static Lone lone(const Sides& s) {
#if defined(__CUDA_ARCH__)
        return lone_by_case(s.above(), s.below());
#else
        return lone_of[s.above_and_below()];
#endif
    }
    BOXWOOD_BOTH static std::size_t around(std::size_t k) {
#if defined(__CUDA_ARCH__)
        return k < 3 ? k : k - 3;
#else
        return corner_around[k];
#endif
    }

    /// The corners of the triangle that begins at `first`, from the lone one on; the last two
    /// swapped if `sign` is -1, which turns the triangle's plane over.
    BOXWOOD_BOTH static Turned from(Corner first, std::uint8_t corner, int sign) {
        const std::size_t flip = sign < 0;
        return {first + corner, first + around(corner + 1 + flip),
                first + around(corner + 2 - flip)};
    }
};

} // namespace boxwood::detail
