#include "kernels/oracle/roots.h"

#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/exact_vector.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <type_traits>

namespace boxwood::oracle {
namespace {

template <class Real> constexpr int digits = std::numeric_limits<Real>::digits;
/// Of the last bit among the denormals.
template <class Real>
constexpr int min_exponent = std::numeric_limits<Real>::min_exponent - digits<Real>;

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

/// The Real nearest to (c.floor + a fraction in (0, 1) if c.more) * 2^exponent > 0, ties to even.
/// c.floor has more bits than a Real.
template <class Real> Real rounded(const Cut& c, long exponent) {
    using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    constexpr long min_power = min_exponent<Real>,
                   max_power = std::numeric_limits<Real>::max_exponent;
    const long bits = static_cast<long>(mpz_sizeinbase(c.floor.get_mpz_t(), 2));
    if (exponent + bits > max_power)
        return std::numeric_limits<Real>::infinity();
    const long last = std::max(exponent + bits - digits<Real>, min_power);
    const auto drop = static_cast<mp_bitcnt_t>(last - exponent); // >= 1
    Integer kept = c.floor >> drop;
    const bool half = mpz_tstbit(c.floor.get_mpz_t(), drop - 1) != 0;
    const bool below = c.more || mpz_scan1(c.floor.get_mpz_t(), 0) < drop - 1;
    if (half && (below || mpz_odd_p(kept.get_mpz_t())))
        ++kept;
    // The leading bit of `kept`, if there, adds 1 to the exponent's bits; so does a carry, and from
    // the largest number it makes infinity.
    const Bits exponent_bits = static_cast<Bits>(last - min_power) << (digits<Real> - 1);
    return std::bit_cast<Real>(static_cast<Bits>(exponent_bits + mpz_get_ui(kept.get_mpz_t())));
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

template <class Real> Real nearest(const mpq_class& x) {
    if (x == 0)
        return 0;
    const mpq_class positive = abs(x);
    const long shift = 64 - size(positive);
    const Real size_of_x = rounded<Real>(cut(positive, shift), -shift);
    return sgn(x) < 0 ? -size_of_x : size_of_x;
}

} // namespace

double nearest_double(const mpq_class& x) { return nearest<double>(x); }
float nearest_float(const mpq_class& x) { return nearest<float>(x); }

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
    return rounded<double>(cut_root(q, shift), -shift);
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
    const auto biased =
        static_cast<int>(std::bit_cast<std::uint64_t>(root) >> (digits<double> - 1));
    // In units of 2^-64 ulp, below which nothing is reported.
    const long shift = 64 - (std::max(biased, 1) - 1 + min_exponent<double>);
    const Cut scaled_root = cut_root(squared, shift);
    const Integer difference = Integer(scaled(exact(d), shift)) - scaled_root.floor;
    long exponent = 0;
    const double leading = mpz_get_d_2exp(&exponent, difference.get_mpz_t());
    return std::ldexp(leading, static_cast<int>(exponent) - 64);
}

} // namespace boxwood::oracle
