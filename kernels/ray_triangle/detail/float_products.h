#pragma once

#include "kernels/predicates/detail/binary64.h"
#include "kernels/primitives/vec3.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace boxwood::detail {

/// An exact sum of signed products of up to four finite floats, in fixed point: bit 0 weighs
/// (2^-149)^4 = 2^-596, a product is below 2^512, and 18 words hold 2^40 of them with their sign.
/// Integers alone: right in every floating-point mode.
class FloatProducts {
  public:
    /// Adds a b c e; with `minus` takes it away.
    void add(float a, float b, float c, float e = 1, bool minus = false) {
        const Parts pa(a), pb(b), pc(c), pe(e);
        const UInt128 low = UInt128{pa.mantissa * pb.mantissa} * pc.mantissa;
        const UInt128 product = low * pe.mantissa; // 96 bits
        if (product == 0)
            return;
        const auto at = static_cast<std::size_t>(pa.shift + pb.shift + pc.shift + pe.shift);
        const std::size_t bit = at % 64;
        const UInt128 shifted = product << bit;
        const std::uint64_t top = bit == 0 ? 0 : static_cast<std::uint64_t>(product >> (128 - bit));
        const std::array<std::uint64_t, 3> parts{static_cast<std::uint64_t>(shifted),
                                                 static_cast<std::uint64_t>(shifted >> 64), top};
        const bool negative =
            ((pa.negative != pb.negative) != (pc.negative != pe.negative)) != minus;
        // Two's complement: x - y = ~(~x + y).
        const std::uint64_t flip = negative ? ~std::uint64_t{0} : 0;
        std::size_t word = at / 64;
        std::uint64_t carry = 0;
        for (std::size_t i = 0; i < 3 || (carry != 0 && word < words); ++i, ++word) {
            const UInt128 sum = UInt128{words_[word] ^ flip} + (i < 3 ? parts[i] : 0) + carry;
            words_[word] = static_cast<std::uint64_t>(sum) ^ flip;
            carry = static_cast<std::uint64_t>(sum >> 64);
        }
    }

    /// Adds a . (b x c) e; with `minus` takes it away.
    void add_volume(Vec3<float> a, Vec3<float> b, Vec3<float> c, float e = 1, bool minus = false) {
        for (int k = 0; k < 3; ++k) {
            const int i = k == 2 ? 0 : k + 1, j = i == 2 ? 0 : i + 1;
            add(a[k], b[i], c[j], e, minus);
            add(a[k], b[j], c[i], e, !minus);
        }
    }

    int sign() const {
        if (words_[words - 1] >> 63 != 0)
            return -1;
        for (const std::uint64_t word : words_)
            if (word != 0)
                return 1;
        return 0;
    }

    /// The sum within 2^-51 relative: 0 or 2^-596 .. 2^552 in size.
    double value() const {
        const bool negative = words_[words - 1] >> 63 != 0;
        std::array<std::uint64_t, words> size = words_;
        if (negative) {
            std::uint64_t carry = 1;
            for (std::uint64_t& word : size) {
                word = ~word + carry;
                carry = carry != 0 && word == 0;
            }
        }
        std::size_t top = words - 1;
        while (top > 0 && size[top] == 0)
            --top;
        double x = static_cast<double>(size[top]);
        if (top > 0)
            x += static_cast<double>(size[top - 1]) * 0x1p-64;
        x = std::ldexp(x, 64 * static_cast<int>(top) - 596);
        return negative ? -x : x;
    }

  private:
    static constexpr std::size_t words = 18;

    /// x = +-mantissa 2^(shift - 149).
    struct Parts {
        std::uint64_t mantissa;
        int shift;
        bool negative;

        explicit Parts(float x) {
            const auto bits = std::bit_cast<std::uint32_t>(x);
            const auto exponent = static_cast<int>(bits >> 23 & 0xff);
            mantissa = (bits & 0x7fffff) | (exponent != 0 ? 0x800000u : 0u);
            shift = exponent != 0 ? exponent - 1 : 0;
            negative = bits >> 31 != 0;
        }
    };

    std::array<std::uint64_t, words> words_{};
};

} // namespace boxwood::detail
