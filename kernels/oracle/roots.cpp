#include "kernels/oracle/roots.h"

#include "kernels/oracle/exact_vector.h"
#include "kernels/oracle/oracle.h"

#include <bit>
#include <cmath>

namespace boxwood::oracle {
namespace {

constexpr int least_exponent = -1074; // of the last bit of a double
constexpr int digits = 53;

/// x * 2^shift rounded down, and whether anything was cut off.
struct Cut {
    Integer floor;
    bool more;
};
Cut cut(const mpq_class& x, long shift) {
    Integer num = x.get_num(), den = x.get_den();
    (shift >= 0 ? num : den) <<= static_cast<mp_bitcnt_t>(std::abs(shift));
    Cut c;
    Integer rest;
    mpz_fdiv_qr(c.floor.get_mpz_t(), rest.get_mpz_t(), num.get_mpz_t(), den.get_mpz_t());
    c.more = rest != 0;
    return c;
}

/// Nearest double, ties to even, to (c.floor + a fraction in (0, 1) if c.more) * 2^exponent >= 0.
/// c.floor has more than 53 bits.
double rounded(const Cut& c, long exponent) {
    const long bits = static_cast<long>(mpz_sizeinbase(c.floor.get_mpz_t(), 2));
    const long last = std::max<long>(exponent + bits - digits, least_exponent);
    const auto drop = static_cast<mp_bitcnt_t>(last - exponent); // >= 1
    Integer kept = c.floor >> drop;
    const bool half = mpz_tstbit(c.floor.get_mpz_t(), drop - 1) != 0;
    const bool below = c.more || mpz_scan1(c.floor.get_mpz_t(), 0) < drop - 1;
    if (half && (below || mpz_odd_p(kept.get_mpz_t())))
        ++kept;
    // A kept of 2^53 carries into the exponent's bits, and so does 2^52 from among the denormals.
    constexpr std::uint64_t one = std::uint64_t{1} << (digits - 1);
    const std::uint64_t mantissa = mpz_get_ui(kept.get_mpz_t());
    const std::uint64_t largest = std::bit_cast<std::uint64_t>(Aabb<double>::inf);
    if (last - least_exponent > 2046)
        return Aabb<double>::inf;
    const std::uint64_t pattern =
        mantissa + static_cast<std::uint64_t>(last - least_exponent) * one;
    return std::bit_cast<double>(std::min(pattern, largest));
}

/// log2 x for x > 0, at most 1 off.
long size(const mpq_class& x) {
    return static_cast<long>(mpz_sizeinbase(x.get_num_mpz_t(), 2)) -
           static_cast<long>(mpz_sizeinbase(x.get_den_mpz_t(), 2));
}

/// sqrt(q) * 2^shift rounded down, and whether anything was cut off.
Cut cut_root(const mpq_class& q, long shift) {
    const Cut square = cut(q, 2 * shift);
    Cut c;
    Integer rest;
    mpz_sqrtrem(c.floor.get_mpz_t(), rest.get_mpz_t(), square.floor.get_mpz_t());
    c.more = square.more || rest != 0;
    return c;
}

} // namespace

double nearest_double(const mpq_class& x) {
    if (x == 0)
        return 0;
    const mpq_class positive = abs(x);
    const long shift = 64 - size(positive);
    const double d = rounded(cut(positive, shift), -shift);
    return sgn(x) < 0 ? -d : d;
}

double next_above(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(std::abs(x));
    return std::isinf(x) ? x : std::bit_cast<double>(bits + 1);
}
double next_below(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(std::abs(x));
    return bits == 0 ? 0 : std::bit_cast<double>(bits - 1);
}

double nearest_sqrt(const mpq_class& q) {
    if (q == 0)
        return 0;
    const long shift = 64 - size(q) / 2;
    return rounded(cut_root(q, shift), -shift);
}

int compare(double d, const mpq_class& squared) {
    if (std::isinf(d))
        return d > 0 ? 1 : -1;
    const mpq_class root = exact(d);
    if (sgn(root) < 0)
        return -1;
    return sgn(mpq_class(root * root - squared));
}

double ulps_off(double d, const mpq_class& squared) {
    if (!std::isfinite(d))
        return d;
    const double root = std::min(nearest_sqrt(squared), std::numeric_limits<double>::max());
    const auto biased = static_cast<int>(std::bit_cast<std::uint64_t>(root) >> (digits - 1));
    // In units of 2^-64 ulp, below which nothing is told.
    const long shift = 64 - (std::max(biased, 1) - 1 + least_exponent);
    const Cut scaled_root = cut_root(squared, shift);
    const Integer difference = Integer(scaled(exact(d), shift)) - scaled_root.floor;
    long exponent = 0;
    const double leading = mpz_get_d_2exp(&exponent, difference.get_mpz_t());
    return std::ldexp(leading, static_cast<int>(exponent) - 64);
}

} // namespace boxwood::oracle
