#pragma once

#include "kernels/arithmetic/detail/long_integer.h"
#include "kernels/arithmetic/on_both.h"

#include <cmath>

/// The distance of two convex sets that do not touch is the greatest gap between two parallel
/// planes that separate them. Their nearest points lie inside two features (corner, edge, face) and
/// there are such of dimensions 0-0, 0-1, 1-1 (not parallel) or 0-2; the planes there are normal to
/// both features. So the distance is the greatest of gap / |n| over 38 directions n, and no gap of
/// another direction is greater. Directions and gaps are whole numbers; what rounds is the
/// quotient.
namespace boxwood::detail {

/// Of whole numbers that have + - * <, sign() and rounded(); a product may be of a longer type.
template <class Integer> struct WholeVector {
    Integer of[3];

    BOXWOOD_BOTH friend WholeVector operator-(const WholeVector& a, const WholeVector& b) {
        return {{a.of[0] - b.of[0], a.of[1] - b.of[1], a.of[2] - b.of[2]}};
    }
};
template <class A, class B>
BOXWOOD_BOTH auto dot(const WholeVector<A>& a, const WholeVector<B>& b) {
    return a.of[0] * b.of[0] + a.of[1] * b.of[1] + a.of[2] * b.of[2];
}
template <class A, class B>
BOXWOOD_BOTH auto cross(const WholeVector<A>& a, const WholeVector<B>& b) {
    using Product = decltype(a.of[0] * b.of[0]);
    return WholeVector<Product>{{a.of[1] * b.of[2] - a.of[2] * b.of[1],
                                 a.of[2] * b.of[0] - a.of[0] * b.of[2],
                                 a.of[0] * b.of[1] - a.of[1] * b.of[0]}};
}

/// sqrt(n.n), within 2^-52 of the parts and 2.5u of the sum and root: 2^-51. Parts 2^-500 as large
/// as the largest do not matter.
template <class Integer> BOXWOOD_BOTH Scaled length_of(const WholeVector<Integer>& n) {
    const Scaled part[3] = {n.of[0].rounded(), n.of[1].rounded(), n.of[2].rounded()};
    int largest = -1000000;
    for (const Scaled& p : part)
        if (p.m != 0)
            largest = p.exponent > largest ? p.exponent : largest;
    double sum = 0;
    for (const Scaled& p : part)
        if (p.m != 0 && p.exponent > largest - 500) {
            const double x = std::ldexp(p.m, p.exponent - largest);
            sum += x * x;
        }
    return {std::sqrt(sum), largest};
}

/// Of two triangles, corners 0, 1, 2 and 3, 4, 5.
template <class Integer> class GreatestGap {
  public:
    using Vector = WholeVector<Integer>;

    BOXWOOD_BOTH explicit GreatestGap(const Vector (&at)[6]) {
        for (int i = 0; i < 6; ++i) {
            edge_[i] = at[i % 3 == 2 ? i - 2 : i + 1] - at[i];
            from_first_[i] = at[i] - at[0];
        }
        try_direction(cross(edge_[0], edge_[1]));
        try_direction(cross(edge_[3], edge_[4]));
        for (int i = 0; i < 3; ++i)
            for (int j = 3; j < 6; ++j) {
                const Vector between = from_first_[j] - from_first_[i];
                try_direction(between);
                try_direction(cross(edge_[i], edge_[j]));
                for (int k = i; k <= j; k += j - i)
                    try_direction(cross(edge_[k], cross(between, edge_[k])));
            }
    }
    /// 0 if they touch.
    BOXWOOD_BOTH Scaled distance() const { return best_; }

  private:
    /// n and the gap are exact, gap / |n| within 2^-52 + 2^-51 + 2^-53.
    template <class Direction>
    BOXWOOD_BOTH [[gnu::noinline]] void try_direction(const Direction& n) {
        using Height = decltype(dot(n, from_first_[3]));
        Height min_a, max_a, min_b = dot(n, from_first_[3]), max_b = min_b;
        const auto widen = [](Height& low, Height& high, const Height& x) {
            if (x < low)
                low = x;
            else if (high < x)
                high = x;
        };
        for (int i = 1; i < 3; ++i) {
            widen(min_a, max_a, dot(n, from_first_[i]));
            widen(min_b, max_b, dot(n, from_first_[3 + i]));
        }
        const Height above = min_a - max_b, below = min_b - max_a;
        const Height& gap = above.sign() > 0 ? above : below;
        if (gap.sign() <= 0)
            return;
        const Scaled size = gap.rounded(), length = length_of(n);
        int exponent = 0;
        const double m = 2 * std::frexp(size.m / length.m, &exponent);
        exponent += size.exponent - length.exponent - 1;
        if (best_.m == 0 || exponent > best_.exponent ||
            (exponent == best_.exponent && m > best_.m))
            best_ = {m, exponent};
    }

    Vector edge_[6], from_first_[6];
    Scaled best_;
};

} // namespace boxwood::detail
