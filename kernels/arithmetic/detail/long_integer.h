#pragma once

#include "kernels/predicates/detail/binary64.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace boxwood::detail {

/// A number m 2^exponent, 1 <= |m| < 2, or m = 0.
struct Scaled {
    double m = 0;
    int exponent = 0;
};

/// A whole number of up to 8704 bits, without allocation; only the words in use are touched. Room
/// for products of four differences of doubles: a difference has 1024 + 1074 + 1 bits, four of them
/// 8396, and sums of six products 3 more; a sum is written with one word above the longer one's.
class LongInteger {
  public:
    LongInteger() = default;
    /// x 2^shift, which must be whole.
    LongInteger(const Binary64& x, int shift) {
        if (x.mantissa == 0)
            return;
        negative_ = x.negative;
        const int at = x.weight + shift;
        if (at <= 0) {
            words_[size_++] = x.mantissa >> -at;
            return;
        }
        const auto first = static_cast<std::size_t>(at / 64);
        const UInt128 wide = UInt128{x.mantissa} << at % 64;
        std::fill_n(words_.begin(), first, 0);
        words_[first] = static_cast<std::uint64_t>(wide);
        words_[first + 1] = static_cast<std::uint64_t>(wide >> 64);
        size_ = first + 2;
        trim();
    }
    LongInteger(const LongInteger& other) { *this = other; }
    LongInteger& operator=(const LongInteger& other) {
        negative_ = other.negative_;
        size_ = other.size_;
        std::copy_n(other.words_.begin(), size_, words_.begin());
        return *this;
    }

    int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }

    friend LongInteger operator-(LongInteger a) {
        a.negative_ = !a.negative_;
        return a;
    }
    friend LongInteger operator+(const LongInteger& a, const LongInteger& b) {
        return sum(a, b, b.negative_);
    }
    friend LongInteger operator-(const LongInteger& a, const LongInteger& b) {
        return sum(a, b, !b.negative_);
    }
    friend LongInteger operator*(const LongInteger& a, const LongInteger& b) {
        LongInteger p;
        if (a.size_ == 0 || b.size_ == 0)
            return p;
        p.negative_ = a.negative_ != b.negative_;
        p.size_ = a.size_ + b.size_;
        std::fill_n(p.words_.begin(), p.size_, 0);
        for (std::size_t i = 0; i < a.size_; ++i) {
            std::uint64_t carry = 0;
            for (std::size_t j = 0; j < b.size_; ++j) {
                const UInt128 at = UInt128{a.words_[i]} * b.words_[j] + p.words_[i + j] + carry;
                p.words_[i + j] = static_cast<std::uint64_t>(at);
                carry = static_cast<std::uint64_t>(at >> 64);
            }
            p.words_[i + b.size_] = carry;
        }
        p.trim();
        return p;
    }
    friend bool operator<(const LongInteger& a, const LongInteger& b) { return (a - b).sign() < 0; }

    /// Within 2^-52, relative: the bits below the upper 64 are cut off, those below 53 rounded.
    Scaled rounded() const {
        if (size_ == 0)
            return {};
        std::uint64_t top = words_[size_ - 1];
        const int zeros = std::countl_zero(top);
        if (zeros > 0 && size_ > 1)
            top = top << zeros | words_[size_ - 2] >> (64 - zeros);
        else
            top <<= zeros;
        const bool up = top >= 0xffff'ffff'ffff'fc00; // rounds to 2
        const double m = up ? 1 : std::ldexp(static_cast<double>(top), -63);
        return {negative_ ? -m : m, static_cast<int>(size_) * 64 - 1 - zeros + up};
    }

  private:
    static constexpr std::size_t max_words = 136;

    static LongInteger sum(const LongInteger& a, const LongInteger& b, bool negative_b) {
        LongInteger s;
        const bool a_is_longer = compare_sizes(a, b) >= 0;
        const LongInteger &large = a_is_longer ? a : b, &small = a_is_longer ? b : a;
        s.negative_ = a_is_longer ? a.negative_ : negative_b;
        s.size_ = large.size_;
        const bool takes = a.negative_ != negative_b;
        std::uint64_t carry = 0;
        for (std::size_t i = 0; i < large.size_; ++i) {
            const std::uint64_t x = large.words_[i], y = i < small.size_ ? small.words_[i] : 0;
            const UInt128 at = takes ? UInt128{x} - y - carry : UInt128{x} + y + carry;
            s.words_[i] = static_cast<std::uint64_t>(at);
            carry = static_cast<std::uint64_t>(at >> 64) & 1;
        }
        if (carry != 0)
            s.words_[s.size_++] = carry;
        s.trim();
        return s;
    }
    /// Of |a| and |b|.
    static int compare_sizes(const LongInteger& a, const LongInteger& b) {
        if (a.size_ != b.size_)
            return a.size_ < b.size_ ? -1 : 1;
        for (std::size_t i = a.size_; i-- > 0;)
            if (a.words_[i] != b.words_[i])
                return a.words_[i] < b.words_[i] ? -1 : 1;
        return 0;
    }
    void trim() {
        while (size_ > 0 && words_[size_ - 1] == 0)
            --size_;
    }

    std::size_t size_ = 0; ///< 0: the number 0
    bool negative_ = false;
    std::array<std::uint64_t, max_words> words_;
};

} // namespace boxwood::detail
