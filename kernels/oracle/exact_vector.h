#pragma once

#include "kernels/primitives/vec3.h"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

/// Exact vectors under the oracle: floats and doubles become integers by one power of two.
namespace boxwood::oracle {

/// A finite number, mantissa * 2^exponent; the mantissa is odd, or 0. Read from the bits, so that
/// flush-to-zero modes change nothing.
struct Binary {
    std::int64_t mantissa = 0;
    int exponent = 0;
};

template <class Real> Binary binary(Real x) {
    static_assert(std::is_same_v<Real, float> || std::is_same_v<Real, double>);
    using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    constexpr int digits = std::numeric_limits<Real>::digits;
    constexpr int min_power = std::numeric_limits<Real>::min_exponent - digits;
    const auto bits = std::bit_cast<Bits>(x);
    const Bits fraction = bits & ((Bits{1} << (digits - 1)) - 1);
    const int biased = static_cast<int>((bits << 1) >> digits);
    Bits size = biased == 0 ? fraction : fraction | (Bits{1} << (digits - 1));
    if (size == 0)
        return {};
    const int zeros = std::countr_zero(size);
    size >>= zeros;
    const auto mantissa = static_cast<std::int64_t>(size);
    return {bits >> (8 * sizeof(Real) - 1) ? -mantissa : mantissa,
            min_power + std::max(biased - 1, 0) + zeros};
}

using Integer = mpz_class;
using Point = std::array<mpz_class, 3>;

/// x * 2^shift.
inline mpq_class scaled(mpq_class x, long shift) {
    if (shift >= 0)
        mpq_mul_2exp(x.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(shift));
    else
        mpq_div_2exp(x.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(-shift));
    return x;
}

/// The rational number that the finite x is.
template <class Real> mpq_class exact(Real x) {
    const Binary b = binary(x);
    return scaled(mpq_class(static_cast<long>(b.mantissa)), b.exponent);
}

/// The power of two, 2^exponent, of which all the numbers given are whole multiples.
class Unit {
  public:
    template <class... T> explicit Unit(const T&... numbers_or_vectors) {
        (cover(numbers_or_vectors), ...);
        if (exponent == none)
            exponent = 0;
    }

    template <class Real> Integer operator()(Real x) const {
        const Binary b = binary(x);
        Integer n(static_cast<long>(b.mantissa));
        if (b.mantissa != 0)
            n <<= static_cast<mp_bitcnt_t>(b.exponent - exponent);
        return n;
    }
    template <class Real> Point operator()(const Vec3<Real>& v) const {
        return {(*this)(v.x), (*this)(v.y), (*this)(v.z)};
    }

    int exponent = none;

  private:
    static constexpr int none = std::numeric_limits<int>::max();

    template <class Real> void cover(Real x) {
        const Binary b = binary(x);
        if (b.mantissa != 0)
            exponent = std::min(exponent, b.exponent);
    }
    template <class Real> void cover(const Vec3<Real>& v) {
        cover(v.x);
        cover(v.y);
        cover(v.z);
    }
};

inline Point operator+(const Point& a, const Point& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Point operator-(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point operator*(const Integer& s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Integer dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline bool is_zero(const Point& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

} // namespace boxwood::oracle
