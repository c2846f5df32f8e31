#pragma once

#include "kernels/predicates/detail/binary64.h"
#include "kernels/triangle_triangle/detail/flat.h"

/// Exact orientation signs of finite floats in integers of fixed length, without allocation.
namespace boxwood::detail {

/// (-1)^negative * mantissa * 2^(weight - 149); mantissa < 2^24, weight 0 .. 253.
struct Binary32 {
    std::uint32_t mantissa;
    int weight;
    bool negative;

    BOXWOOD_BOTH explicit Binary32(float x) : mantissa(0), weight(0), negative(false) {
        const auto bits = bits_as<std::uint32_t>(x);
        const int exponent = static_cast<int>(bits >> 23 & 0xff);
        mantissa = (bits & 0x7fffff) | (exponent > 0 ? 0x800000 : 0);
        weight = exponent > 0 ? exponent - 1 : 0;
        negative = bits >> 31 != 0;
    }
    BOXWOOD_BOTH static bool is_finite(float x) {
        return (bits_as<std::uint32_t>(x) & 0x7f800000) != 0x7f800000;
    }
};

/// Six points, each axis in multiples of its own power of two (which changes no sign), if all are
/// below 2^58 then: the exponents of its coordinates are at most 34 apart. Differences are below
/// 2^59, minors below 2^119, and what dot_sign sums below 2^124.
class NarrowFloats {
  public:
    static constexpr int bits = 58;

    /// False if the points, which are finite, do not fit.
    BOXWOOD_BOTH bool place(const Vec3<float> (&p)[6]) {
        for (int axis = 0; axis < 3; ++axis) {
            int low = 255, high = 0;
            for (const Vec3<float>& point : p)
                if (const Binary32 x(point[axis]); x.mantissa != 0) {
                    low = x.weight < low ? x.weight : low;
                    high = x.weight > high ? x.weight : high;
                }
            if (high - low > bits - 24)
                return false;
            for (int k = 0; k < 6; ++k) {
                const Binary32 x(p[k][axis]);
                const std::int64_t size =
                    x.mantissa == 0 ? 0 : std::int64_t{x.mantissa} << (x.weight - low);
                at_[k][axis] = x.negative ? -size : size;
            }
        }
        return true;
    }
    BOXWOOD_BOTH [[gnu::noinline]] int orient3d(Corner a, Corner b, Corner c, Corner d) const {
        const auto of = [&](Corner k, int axis) { return at_[k][axis] - at_[a][axis]; };
        Int128 lower = 0, upper = 0;
        for (int u = 0; u < 3; ++u) {
            const int v = u == 2 ? 0 : u + 1, w = u == 0 ? 2 : u - 1;
            const Int128 n = Int128{of(b, v)} * of(c, w) - Int128{of(b, w)} * of(c, v);
            lower += Int128{static_cast<std::int64_t>(n & low_digit)} * of(d, u);
            upper += Int128{static_cast<std::int64_t>(n >> digit)} * of(d, u);
        }
        upper += lower >> digit;
        return upper != 0 ? (upper > 0 ? 1 : -1) : (lower & low_digit) != 0;
    }
    BOXWOOD_BOTH [[gnu::noinline]] int orient2d(int u, int v, Corner a, Corner b, Corner c) const {
        const auto of = [&](Corner k, int axis) { return at_[k][axis] - at_[a][axis]; };
        const Int128 left = Int128{of(b, u)} * of(c, v), right = Int128{of(b, v)} * of(c, u);
        return int{left > right} - int{left < right};
    }

  private:
    static constexpr int digit = 56;
    static constexpr std::int64_t low_digit = (std::int64_t{1} << digit) - 1;
    std::int64_t at_[6][3];
};

/// An exact sum of products of three floats in units of 2^-447. A product is below 2^(759 + 72), 24
/// of them below 2^836: 896 bits in two's complement hold all that finite floats can make.
class FloatAccumulator {
  public:
    BOXWOOD_BOTH void add(const Binary32& a, const Binary32& b, bool minus = false) {
        add(UInt128{a.mantissa} * b.mantissa, a.weight + b.weight,
            (a.negative != b.negative) != minus);
    }
    BOXWOOD_BOTH void add(const Binary32& a, const Binary32& b, const Binary32& c,
                          bool minus = false) {
        add(UInt128{a.mantissa} * b.mantissa * c.mantissa, a.weight + b.weight + c.weight,
            ((a.negative != b.negative) != c.negative) != minus);
    }
    BOXWOOD_BOTH int sign() const {
        if (word_[words - 1] >> 63 != 0)
            return -1;
        std::uint64_t any = 0;
        for (const std::uint64_t w : word_)
            any |= w;
        return any != 0;
    }

  private:
    static constexpr int words = 14;

    BOXWOOD_BOTH void add(UInt128 product, int at, bool minus) {
        const int bit = at % 64;
        // Below 2^72, so that its upper word keeps the bits of the shift.
        const UInt128 low = UInt128{static_cast<std::uint64_t>(product)} << bit,
                      high = UInt128{static_cast<std::uint64_t>(product >> 64)} << bit;
        const std::uint64_t part[3] = {static_cast<std::uint64_t>(low),
                                       static_cast<std::uint64_t>(low >> 64) |
                                           static_cast<std::uint64_t>(high),
                                       static_cast<std::uint64_t>(high >> 64)};
        // -x is ~x + 1, whose upper words are all ones.
        const std::uint64_t flip = minus ? ~std::uint64_t{0} : 0;
        std::uint64_t carry = minus;
        for (int i = at / 64, k = 0; i < words; ++i, ++k) {
            const UInt128 sum = UInt128{word_[i]} + ((k < 3 ? part[k] : 0) ^ flip) + carry;
            word_[i] = static_cast<std::uint64_t>(sum);
            carry = static_cast<std::uint64_t>(sum >> 64);
        }
    }
    std::uint64_t word_[words]{};
};

/// Six points of finite floats, whatever their exponents.
class WideFloats {
  public:
    BOXWOOD_BOTH bool place(const Vec3<float> (&p)[6]) {
        for (int k = 0; k < 6; ++k)
            at_[k] = p[k];
        return true;
    }
    BOXWOOD_BOTH [[gnu::noinline]] int orient3d(Corner a, Corner b, Corner c, Corner d) const {
        // |b c d| - |a c d| + |a b d| - |a b c|
        FloatAccumulator sum;
        add_determinant(sum, b, c, d, false);
        add_determinant(sum, a, c, d, true);
        add_determinant(sum, a, b, d, false);
        add_determinant(sum, a, b, c, true);
        return sum.sign();
    }
    BOXWOOD_BOTH [[gnu::noinline]] int orient2d(int u, int v, Corner a, Corner b, Corner c) const {
        // a x b + b x c + c x a
        FloatAccumulator sum;
        const Corner of[4] = {a, b, c, a};
        for (int i = 0; i < 3; ++i) {
            sum.add(at(of[i], u), at(of[i + 1], v));
            sum.add(at(of[i + 1], u), at(of[i], v), true);
        }
        return sum.sign();
    }

  private:
    BOXWOOD_BOTH Binary32 at(Corner k, int axis) const { return Binary32(at_[k][axis]); }
    BOXWOOD_BOTH [[gnu::noinline]] void add_determinant(FloatAccumulator& sum, Corner q, Corner r,
                                                        Corner s, bool minus) const {
        for (int k = 0; k < 3; ++k) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            sum.add(at(q, k), at(r, l), at(s, m), minus);
            sum.add(at(q, k), at(r, m), at(s, l), !minus);
        }
    }
    Vec3<float> at_[6];
};

/// The signs of a pair of finite triangles on NarrowFloats or WideFloats: none is undecided.
template <class Grid> class FloatSigns {
  public:
    using Real = float;

    BOXWOOD_BOTH FloatSigns(const Triangle<float>& a, const Triangle<float>& b)
        : p_{a.a, a.b, a.c, b.a, b.b, b.c}, fits_(grid_.place(p_)) {}
    BOXWOOD_BOTH bool fits() const { return fits_; }

    BOXWOOD_BOTH Sides sides(int of) const {
        const Corner t = of == 0 ? 0 : 3, other = 3 - t;
        Sides s;
        for (Corner k = 0; k < 3; ++k)
            s.decide(k, orient3d(t, t + 1, t + 2, other + k));
        return s;
    }
    BOXWOOD_BOTH Sides decided_sides(int of) const { return sides(of); }
    BOXWOOD_BOTH Projection project(int of, Projection like) const {
        return project_by_orient2d(*this, of, like ? like.axis() : 0);
    }
    BOXWOOD_BOTH Answer overlap_along_line(const Turned& a, const Turned& b) const {
        return overlap_by_orient3d(*this, a, b);
    }
    BOXWOOD_BOTH int orient3d(Corner a, Corner b, Corner c, Corner d) const {
        return grid_.orient3d(a, b, c, d);
    }
    BOXWOOD_BOTH int orient2d(int dropped, Corner a, Corner b, Corner c) const {
        return grid_.orient2d((dropped + 1) % 3, (dropped + 2) % 3, a, b, c);
    }
    BOXWOOD_BOTH Answer overlap_in_plane(int dropped, int turn_a, int turn_b) const {
        return overlap_by_orient2d(*this, dropped, {turn_a, turn_b});
    }
    BOXWOOD_BOTH Vec3<float> point(Corner k) const { return p_[k]; }

  private:
    Vec3<float> p_[6];
    Grid grid_;
    bool fits_;
};

} // namespace boxwood::detail
