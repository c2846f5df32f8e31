#pragma once

#include "kernels/arithmetic/detail/long_integer.h"
#include "kernels/arithmetic/on_both.h"

namespace boxwood::detail {

/// A whole number of 64 n bits in two's complement. A sum has the length of its parts, which the
/// caller must know to be enough; a product that of its factors together, which always is.
template <int n> struct FixedInteger {
    std::uint64_t word[static_cast<unsigned>(n)]{};

    BOXWOOD_BOTH bool negative() const { return word[n - 1] >> 63 != 0; }
    BOXWOOD_BOTH int sign() const {
        std::uint64_t any = 0;
        for (const std::uint64_t w : word)
            any |= w;
        return negative() ? -1 : any != 0;
    }

    BOXWOOD_BOTH friend FixedInteger operator+(const FixedInteger& a, const FixedInteger& b) {
        return sum(a, b, 0);
    }
    BOXWOOD_BOTH friend FixedInteger operator-(const FixedInteger& a, const FixedInteger& b) {
        return sum(a, b, ~std::uint64_t{0}); // a + ~b + 1
    }
    BOXWOOD_BOTH friend bool operator<(const FixedInteger& a, const FixedInteger& b) {
        return (a - b).negative();
    }

    /// As LongInteger's.
    BOXWOOD_BOTH Scaled rounded() const {
        const FixedInteger size = negative() ? FixedInteger{} - *this : *this;
        int i = n - 1;
        while (i >= 0 && size.word[i] == 0)
            --i;
        if (i < 0)
            return {};
        std::uint64_t top = size.word[i];
        int zeros = 0;
        while (top >> 63 == 0) {
            top <<= 1;
            ++zeros;
        }
        if (zeros > 0 && i > 0)
            top |= size.word[i - 1] >> (64 - zeros);
        const bool up = top >= 0xffff'ffff'ffff'fc00; // rounds to 2
        const double m = up ? 1 : static_cast<double>(top) * 0x1p-63;
        return {negative() ? -m : m, i * 64 + 63 - zeros + up};
    }

  private:
    BOXWOOD_BOTH static FixedInteger sum(const FixedInteger& a, const FixedInteger& b,
                                         std::uint64_t flip) {
        FixedInteger s;
        std::uint64_t carry = flip & 1;
        for (int i = 0; i < n; ++i) {
            const UInt128 at = UInt128{a.word[i]} + (b.word[i] ^ flip) + carry;
            s.word[i] = static_cast<std::uint64_t>(at);
            carry = static_cast<std::uint64_t>(at >> 64);
        }
        return s;
    }
};

template <int n, int m>
BOXWOOD_BOTH [[gnu::noinline]] FixedInteger<n + m> operator*(const FixedInteger<n>& a,
                                                             const FixedInteger<m>& b) {
    FixedInteger<n + m> p;
    for (int i = 0; i < n; ++i) {
        std::uint64_t carry = 0;
        for (int j = 0; j < m; ++j) {
            const UInt128 at = UInt128{a.word[i]} * b.word[j] + p.word[i + j] + carry;
            p.word[i + j] = static_cast<std::uint64_t>(at);
            carry = static_cast<std::uint64_t>(at >> 64);
        }
        p.word[i + m] = carry;
    }
    // That took a negative a for a + 2^(64 n), and so b.
    const auto take_away = [&p](bool is, const auto& x, int at, int length) {
        std::uint64_t borrow = 0;
        for (int i = 0; is && i < length; ++i) {
            const UInt128 left = UInt128{p.word[at + i]} - x.word[i] - borrow;
            p.word[at + i] = static_cast<std::uint64_t>(left);
            borrow = static_cast<std::uint64_t>(left >> 64) & 1;
        }
    };
    take_away(a.negative(), b, n, m);
    take_away(b.negative(), a, m, n);
    return p;
}

} // namespace boxwood::detail
