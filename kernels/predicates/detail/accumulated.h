#pragma once

#include "kernels/predicates/detail/binary64.h"
#include "kernels/predicates/orientation.h"

#include <array>
#include <cstddef>

namespace boxwood::detail {

/// An exact sum of signed products of up to three finite doubles: two fixed-point numbers without
/// rounding, what was added and what was taken away. Bit 0 weighs 2^-3222 = (2^-1074)^3; a product
/// has bits below 3 * 2045 + 3 * 53 = 6294, so 100 words hold 2^100 of them.
class Superaccumulator {
  public:
    /// Adds a b c, or takes it away.
    void add(const Binary64& a, const Binary64& b, const Binary64& c, bool minus = false) {
        add(a, b, c.mantissa, c.weight, c.negative != minus);
    }
    /// Adds a b * 2^-1074, or takes it away: for sums of products of two, whose sign it keeps.
    void add(const Binary64& a, const Binary64& b, bool minus = false) { add(a, b, 1, 0, minus); }
    int sign() const {
        for (std::size_t i = words; i-- > 0;)
            if (sums_[0][i] != sums_[1][i])
                return sums_[0][i] > sums_[1][i] ? 1 : -1;
        return 0;
    }

  private:
    static constexpr std::size_t words = 100;

    void add(const Binary64& a, const Binary64& b, std::uint64_t m, int weight, bool minus) {
        const UInt128 ab = UInt128{a.mantissa} * b.mantissa;
        if (ab == 0 || m == 0)
            return;
        // The 159-bit product, shifted into four words.
        const UInt128 low = UInt128{static_cast<std::uint64_t>(ab)} * m;
        const UInt128 high = UInt128{static_cast<std::uint64_t>(ab >> 64)} * m + (low >> 64);
        const auto at = static_cast<std::size_t>(a.weight + b.weight + weight);
        const std::size_t bit = at % 64;
        const UInt128 l = UInt128{static_cast<std::uint64_t>(low)} << bit;
        const UInt128 h = high << bit; // < 2^(95 + 63): the top 64 bits are kept apart
        const std::uint64_t top = bit == 0 ? 0 : static_cast<std::uint64_t>(high >> (128 - bit));
        const std::array<std::uint64_t, 4> product{static_cast<std::uint64_t>(l),
                                                   static_cast<std::uint64_t>(l >> 64) |
                                                       static_cast<std::uint64_t>(h),
                                                   static_cast<std::uint64_t>(h >> 64), top};

        std::uint64_t* word = sums_[a.negative != (b.negative != minus)].data() + at / 64;
        std::uint64_t carry = 0;
        for (const std::uint64_t part : product) {
            const UInt128 sum = UInt128{*word} + part + carry;
            *word++ = static_cast<std::uint64_t>(sum);
            carry = static_cast<std::uint64_t>(sum >> 64);
        }
        while (carry != 0)
            carry = ++*word++ == 0;
    }

    std::array<std::array<std::uint64_t, words>, 2> sums_{};
};

/// Orientation signs by a Superaccumulator: exact for all finite doubles, whatever their exponents
/// and the floating-point mode. Slow; the last tier of Exact.
struct Accumulated {
    using Real = double;
    static constexpr std::string_view name = "accumulated";
    static constexpr std::string_view summary = "24 products summed in 6400-bit fixed point";
    static constexpr std::string_view bound = "exact";
    static constexpr std::string_view cost = "about 100 times f64";
    static constexpr Promise promise = Promise::exact;
    static constexpr std::uint8_t tier = 3;

    static int orient3d(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c,
                        const Vec3<double>& d) {
        // det(b - a, c - a, d - a) = |b c d| - |a c d| + |a b d| - |a b c|
        const Point p[4] = {Point(a), Point(b), Point(c), Point(d)};
        Superaccumulator sum;
        const auto add = [&](const Point& q, const Point& r, const Point& s, bool minus) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
                sum.add(q[k], r[l], s[m], minus);
                sum.add(q[k], r[m], s[l], !minus);
            }
        };
        add(p[1], p[2], p[3], false);
        add(p[0], p[2], p[3], true);
        add(p[0], p[1], p[3], false);
        add(p[0], p[1], p[2], true);
        return sum.sign();
    }
    static int orient2d(Point2<double> a, Point2<double> b, Point2<double> c) {
        // a x b + b x c + c x a
        const Binary64 x[3] = {Binary64(a.x), Binary64(b.x), Binary64(c.x)};
        const Binary64 y[3] = {Binary64(a.y), Binary64(b.y), Binary64(c.y)};
        Superaccumulator sum;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            sum.add(x[i], y[j]);
            sum.add(x[j], y[i], true);
        }
        return sum.sign();
    }

  private:
    struct Point : std::array<Binary64, 3> {
        explicit Point(const Vec3<double>& p)
            : std::array<Binary64, 3>{Binary64(p.x), Binary64(p.y), Binary64(p.z)} {}
    };
};

} // namespace boxwood::detail
