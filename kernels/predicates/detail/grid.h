#pragma once

#include "kernels/predicates/detail/binary64.h"
#include "kernels/predicates/detail/two.h"
#include "kernels/primitives/vec3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace boxwood::detail {

/// `points` points of doubles as integers: each axis a multiple of its own power of two (positive
/// factors per axis change no orientation sign). A number is `digits` digits in base 2^60, the
/// upper one signed, the others not negative; so are differences, except that all their digits are
/// signed and below 2^61. Sums of products of digits stay below 2^127 (cases at each function).
template <std::size_t digits, std::size_t points> class Grid {
    static_assert(digits == 1 || digits == 2, "see normal() and sign() for the room in Int128");

  public:
    using Number = std::array<std::int64_t, digits>;
    using Difference = Vec3<Number>;
    using Minor = std::array<std::int64_t, 2 * digits>; ///< the digits of a 2 x 2 determinant
    using Normal = std::array<Minor, 3>;

    /// False if the points do not fit: then the grid says nothing. The points are finite, and
    /// denormals are kept (float_mode.h).
    bool place(const std::array<const Vec3<double>*, points>& p) {
        return place<&Vec3<double>::x>(p, at_[0]) && place<&Vec3<double>::y>(p, at_[1]) &&
               place<&Vec3<double>::z>(p, at_[2]);
    }

    /// (b - a) x (c - a).
    Normal normal(std::size_t a, std::size_t b, std::size_t c) const {
        return cross(difference(b, a), difference(c, a));
    }
    /// Sign of (d - a) . n.
    int side(const Normal& n, std::size_t a, std::size_t d) const {
        return dot_sign(n, difference(d, a));
    }
    int orient3d(std::size_t a, std::size_t b, std::size_t c, std::size_t d) const {
        return side(normal(a, b, c), a, d);
    }
    /// In the plane of the axes u, v.
    int orient2d(int u, int v, std::size_t a, std::size_t b, std::size_t c) const {
        const Axis &x = at_[static_cast<std::size_t>(u)], &y = at_[static_cast<std::size_t>(v)];
        return sign(minor(minus(x, b, a), minus(y, c, a), minus(y, b, a), minus(x, c, a)));
    }
    static int sign(const Minor& m) {
        bool below = false;
        for (std::size_t i = 0; i + 1 < m.size(); ++i)
            below |= m[i] != 0;
        return m.back() != 0 ? (m.back() > 0 ? 1 : -1) : below;
    }

  private:
    static constexpr int digit_bits = 60;
    static constexpr std::int64_t low_digit = (std::int64_t{1} << digit_bits) - 1;

    using Axis = std::array<Number, points>;

    template <double Vec3<double>::*axis>
    static bool place(const std::array<const Vec3<double>*, points>& p, Axis& at) {
        if constexpr (digits == 1)
            return place_narrow<axis>(p, at, std::make_index_sequence<(points + 1) / 2>());
        else
            return place_wide<axis>(p, at);
    }

    /// 2^e <= the largest < 2^(e+1): times 2^(59 - e) all are below 2^60, and that is exact, but
    /// for what underflows. Two points at a time, an odd last one twice.
    template <double Vec3<double>::*axis, std::size_t... i>
    static bool place_narrow(const std::array<const Vec3<double>*, points>& p, Axis& at,
                             std::index_sequence<i...>) {
        using Two = TwoOf<double>::Values;
        using Bits = TwoOf<double>::Unsigned;
        constexpr std::uint64_t one = std::uint64_t{1} << 52; // in the exponent
        constexpr std::uint64_t no_sign = ~(std::uint64_t{1} << 63);
        constexpr auto second = [](std::size_t k) { return std::min(2 * k + 1, points - 1); };
        const Two x[] = {Two{p[2 * i]->*axis, p[second(i)]->*axis}...};
        Two max_value{};
        const auto grow = [&max_value](const Two& v) { max_value = max_value < v ? v : max_value; };
        (grow(std::bit_cast<Two>(std::bit_cast<Bits>(x[i]) & no_sign)), ...);
        grow(__builtin_shufflevector(max_value, max_value, 1, 0));
        if (!(max_value[0] >= 0x1p-900))
            return max_value[0] == 0 && clear(at);
        const Bits power = std::bit_cast<Bits>(max_value) & (0x7ff * one); // e + 1023
        const Two up = std::bit_cast<Two>((1023 + 59 + 1023) * one - power);
        const Two down = std::bit_cast<Two>(power - 59 * one);
        Bits lost{};
        const auto put = [&](const Two& v, Number& first, Number& other) {
            const Two scaled = v * up;
            const auto a = static_cast<std::int64_t>(scaled[0]);
            const auto b = static_cast<std::int64_t>(scaled[1]);
            first = {a};
            other = {b};
            const Two back{static_cast<double>(a), static_cast<double>(b)};
            lost |= std::bit_cast<Bits>(back * down - v);
        };
        (put(x[i], at[2 * i], at[second(i)]), ...);
        return (lost[0] | lost[1]) == 0;
    }

    template <double Vec3<double>::*axis>
    static bool place_wide(const std::array<const Vec3<double>*, points>& p, Axis& at) {
        constexpr int room = digit_bits * 2 - 53;
        int low = 2046, high = 0;
        for (const Vec3<double>* q : p)
            if (const Binary64 x(q->*axis); x.mantissa != 0) {
                low = std::min(low, x.weight);
                high = std::max(high, x.weight);
            }
        if (high - low > room)
            return false;
        for (std::size_t i = 0; i < points; ++i) {
            const Binary64 x(p[i]->*axis);
            const Int128 size = x.mantissa == 0 ? 0 : Int128{x.mantissa} << (x.weight - low);
            const Int128 value = x.negative ? -size : size;
            at[i] = {static_cast<std::int64_t>(value & low_digit),
                     static_cast<std::int64_t>(value >> digit_bits)};
        }
        return true;
    }
    static bool clear(Axis& at) {
        at = {};
        return true;
    }
    static Number minus(const Axis& at, std::size_t a, std::size_t b) {
        Number d;
        for (std::size_t i = 0; i < digits; ++i)
            d[i] = at[a][i] - at[b][i];
        return d;
    }
    Difference difference(std::size_t a, std::size_t b) const {
        return {minus(at_[0], a, b), minus(at_[1], a, b), minus(at_[2], a, b)};
    }

    /// a d - b c. A column has at most 2 * digits products of 2^122: below 2^124. The value is
    /// below 2 * (2 * 2^(60 digits))^2, so that the upper digit is below 2^63.
    static Minor minor(const Number& a, const Number& d, const Number& b, const Number& c) {
        std::array<Int128, 2 * digits - 1> column{};
        for (std::size_t i = 0; i < digits; ++i)
            for (std::size_t j = 0; j < digits; ++j)
                column[i + j] += Int128{a[i]} * d[j] - Int128{b[i]} * c[j];
        Minor m;
        Int128 carry = 0;
        for (std::size_t i = 0; i < column.size(); ++i) {
            carry += column[i];
            m[i] = static_cast<std::int64_t>(carry & low_digit);
            carry >>= digit_bits;
        }
        m.back() = static_cast<std::int64_t>(carry);
        return m;
    }
    static Normal cross(const Difference& a, const Difference& b) {
        return {minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)};
    }

    /// A column has at most 3 * digits products; those of an upper digit are below 2^63 * 2^61 and
    /// meet at most 3 * (digits - 1) of 2^60 * 2^61: below 2^126.
    static int dot_sign(const Normal& n, const Difference& d) {
        std::array<Int128, 3 * digits - 1> column{};
        for (std::size_t i = 0; i < 2 * digits; ++i)
            for (std::size_t j = 0; j < digits; ++j)
                column[i + j] +=
                    Int128{n[0][i]} * d.x[j] + Int128{n[1][i]} * d.y[j] + Int128{n[2][i]} * d.z[j];
        Int128 carry = 0;
        std::int64_t below = 0;
        for (std::size_t i = 0; i + 1 < column.size(); ++i) {
            carry += column[i];
            below |= static_cast<std::int64_t>(carry & low_digit);
            carry >>= digit_bits;
        }
        carry += column.back();
        return carry != 0 ? (carry > 0 ? 1 : -1) : below != 0;
    }

    std::array<Axis, 3> at_;
};

} // namespace boxwood::detail
