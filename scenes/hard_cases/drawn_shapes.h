#pragma once

#include "scenes/hard_cases/rounded.h"

#include <cmath>
#include <cstddef>

/// Convex shapes drawn for the families of pairs, and cases of such pairs.
namespace boxwood {

struct Ball {
    Vec3<double> centre{};
    double radius = 0;
};

/// A shape, turned but without a place, and a ball inside it.
struct Drawn {
    ShapeOfPair posed;
    Ball ball;

    /// Its point farthest along n, both in its frame, and not by the kernels' functions.
    Vec3<double> farthest_along(Vec3<double> n) const;
    double reach() const; ///< at least its length
};

/// `thin`: one of its lengths is so many times smaller.
Drawn draw_shape(convex::ShapeKind kind, Draws& draws, double thin = 1);
convex::ShapeKind draw_kind(Draws& draws);

/// Rounding may move the places that pairs are made from by some of the size of both.
ShapePairCase with_slack(const Drawn& a, const Drawn& b, double lo, double hi);

ShapeOfPair scaled(ShapeOfPair posed, int exponent);

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

/// Scales where rounding is below the 1e-6 at which libraries end, whatever the size: beyond them
/// FCL's expanding polytope never ends.
HardCaseFamily in_range(HardCaseFamily family);

} // namespace boxwood
