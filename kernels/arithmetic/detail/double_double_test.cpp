#include "kernels/arithmetic/detail/double_double.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace boxwood {
namespace {

using namespace detail;

mpq_class exact(DoubleDouble x) { return mpq_class(x.hi) + mpq_class(x.lo); }

/// |got / wanted - 1|; 0 if both are 0.
double relative_error(DoubleDouble got, const mpq_class& wanted) {
    const mpq_class error = exact(got) - wanted;
    return sgn(error) == 0 ? 0 : mpq_class(abs(error) / abs(wanted)).get_d();
}

TEST(DoubleDouble, KeepsItsBounds) {
    std::mt19937_64 engine(1);
    const auto number = [&] {
        const auto below = [&](int n) { return std::uniform_int_distribution(0, n - 1)(engine); };
        const auto part = [&] { return std::uniform_real_distribution<double>(-1, 1)(engine); };
        const double hi = std::ldexp(part(), below(40) - 20);
        return DoubleDouble::sum(hi, below(4) == 0 ? 0 : std::ldexp(part() * hi, -53));
    };
    for (int i = 0; i < 60000; ++i) {
        const DoubleDouble a = number();
        DoubleDouble b = number();
        if (i % 4 == 0) // nearly cancels
            b = DoubleDouble::sum(-a.hi, std::ldexp(b.hi, -i % 120));
        const mpq_class x = exact(a), y = exact(b);
        ASSERT_LE(relative_error(a + b, x + y), 0x1p-103);
        ASSERT_LE(relative_error(a - b, x - y), 0x1p-103);
        ASSERT_LE(relative_error(a * b, x * y), 0x1p-103);
        if (sgn(y) != 0) {
            ASSERT_LE(relative_error(a / b, x / y), 0x1p-100);
        }
        ASSERT_EQ(a < b, x < y);
        ASSERT_EQ(exact(DoubleDouble::sum(a.hi, b.lo)), mpq_class(a.hi) + mpq_class(b.lo));
        ASSERT_EQ(exact(DoubleDouble::difference(a.hi, b.hi)), mpq_class(a.hi) - mpq_class(b.hi));
        ASSERT_EQ(exact(DoubleDouble::product(a.hi, b.hi)), mpq_class(a.hi) * mpq_class(b.hi));
    }
}

} // namespace
} // namespace boxwood
