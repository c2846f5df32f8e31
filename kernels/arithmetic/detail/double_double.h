#pragma once

namespace boxwood::detail {

/// An unevaluated sum of two doubles, about 106 bits. +, - (unlike signs too) and * are within
/// 8u^2 = 2^-103 of the exact result, relative, quotients within 2^-100, while products stay
/// between 2^-900 and 2^900. Source: Joldes, Muller, Popescu 2017, "Tight and rigorous error bounds
/// for basic building blocks of double-word arithmetic" (3u^2 + 13u^3; 7u^2); Dekker 1971.
struct DoubleDouble {
    double hi, lo;

    /// a + b, a - b, a * b: exact.
    static DoubleDouble sum(double a, double b) {
        const double s = a + b, t = s - a;
        return {s, (a - (s - t)) + (b - t)};
    }
    static DoubleDouble difference(double a, double b) { return sum(a, -b); }
    static DoubleDouble product(double a, double b) {
        const auto [ah, al] = halves(a);
        const auto [bh, bl] = halves(b);
        const double p = a * b;
        return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
    }

    friend DoubleDouble operator-(DoubleDouble a) { return {-a.hi, -a.lo}; }
    friend DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
        const DoubleDouble s = sum(a.hi, b.hi), t = sum(a.lo, b.lo);
        const DoubleDouble v = ordered_sum(s.hi, s.lo + t.hi);
        return ordered_sum(v.hi, t.lo + v.lo);
    }
    friend DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }
    friend DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
        const DoubleDouble p = product(a.hi, b.hi);
        return ordered_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
    }
    friend DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
        const double first = a.hi / b.hi;
        const DoubleDouble rest = a - DoubleDouble{first, 0} * b;
        return ordered_sum(first, rest.hi / b.hi);
    }
    friend bool operator<(DoubleDouble a, DoubleDouble b) {
        return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
    }

  private:
    struct Halves {
        double high, low;
    };
    /// 26 bits each.
    static Halves halves(double a) {
        const double c = 0x8000001p0 * a, high = c - (c - a);
        return {high, a - high};
    }
    /// |a| >= |b|, or a = 0.
    static DoubleDouble ordered_sum(double a, double b) {
        const double s = a + b;
        return {s, b - (s - a)};
    }
};

} // namespace boxwood::detail
