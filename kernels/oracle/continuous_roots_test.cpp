#include "kernels/oracle/continuous_roots.h"

#include "kernels/oracle/roots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace boxwood::oracle {
namespace {

/// denominator * t - numerator.
Polynomial root_at(long numerator, long denominator) { return {{-numerator, denominator, 0, 0}}; }
Polynomial constant(long c) { return {{c, 0, 0, 0}}; }
/// t^2 - 2 s t + s^2 + 1: no real root.
Polynomial rootless(long s) { return {{s * s + 1, -2 * s, 1, 0}}; }

/// Whether the bracket is q itself or the doubles next to it.
void expect_at(Root& root, const mpq_class& q) {
    const auto [below, above] = root.bracket();
    EXPECT_LE(exact(below), q);
    EXPECT_GE(exact(above), q);
    EXPECT_EQ(above, exact(below) == q ? below : next_above(below));
}

TEST(PolynomialRoots, OfProductsOfRationalRoots) {
    std::mt19937_64 random(3);
    std::uniform_int_distribution<long> numerator(-3, 12), denominator(1, 9), scale(-5, 5);
    for (int i = 0; i < 3000; ++i) {
        const int degree = i % 4;
        Polynomial f = constant(scale(random) * 2 + 1);
        std::set<mpq_class> inside;
        for (int k = 0; k < degree; ++k) {
            const long n = numerator(random), d = denominator(random);
            f = f * root_at(n, d);
            if (n >= 0 && n <= d)
                inside.insert(mpq_class(mpz_class(n), mpz_class(d)));
        }
        std::set<mpq_class> expected;
        for (mpq_class q : inside) {
            q.canonicalize();
            expected.insert(q);
        }
        std::vector<Root> roots = roots_in_unit_interval(f);
        ASSERT_EQ(roots.size(), expected.size()) << i;
        auto next = expected.begin();
        for (Root& root : roots) {
            EXPECT_EQ(root.sign_of(f), 0);
            EXPECT_EQ(root.sign_of(root_at(next->get_num().get_si(), next->get_den().get_si())), 0);
            EXPECT_EQ(root.sign_of(root_at(1, 7)), sgn(mpq_class(*next - mpq_class(1, 7))));
            expect_at(root, *next++);
        }
    }
}

TEST(PolynomialRoots, NoneOfZeroAndOfRootless) {
    EXPECT_TRUE(roots_in_unit_interval({}).empty());
    EXPECT_TRUE(roots_in_unit_interval(constant(-4)).empty());
    EXPECT_TRUE(roots_in_unit_interval(rootless(0)).empty());
    EXPECT_EQ(roots_in_unit_interval(rootless(1) * root_at(1, 3)).size(), 1u);
}

TEST(PolynomialRoots, IrrationalOnesKeepTheirOrder) {
    // 2 t^2 - 1 at 0.7071..., 2 t^3 - 1 at 0.7937..., and 4 t^3 - 3 t + 0 at 0.8660...
    const Polynomial square{{-1, 0, 2, 0}}, cube{{-1, 0, 0, 2}}, third{{0, -3, 0, 4}};
    Root a = roots_in_unit_interval(square).at(0), b = roots_in_unit_interval(cube).at(0);
    Root c = roots_in_unit_interval(third).at(1);
    EXPECT_EQ(compare(a, b), -1);
    EXPECT_EQ(compare(b, a), 1);
    EXPECT_EQ(compare(b, c), -1);
    // The same number as a root of another polynomial: (2 t^2 - 1) (3 t - 1).
    Root again = roots_in_unit_interval(square * root_at(1, 3)).at(1);
    EXPECT_EQ(compare(a, again), 0);
    EXPECT_EQ(a.sign_of(square * root_at(2, 5)), 0);
    EXPECT_EQ(a.sign_of(square * root_at(2, 5) + constant(1)), 1);
    const auto [below, above] = a.bracket();
    EXPECT_EQ(above, next_above(below));
    EXPECT_LT(2 * exact(below) * exact(below), 1);
    EXPECT_GT(2 * exact(above) * exact(above), 1);
}

TEST(PolynomialRoots, CloseAndTinyOnes) {
    // Roots 2^-200 apart, and one at 2^-1500, below all doubles.
    const Polynomial close{{(Integer(1) << 200) / 3, -(Integer(1) << 200), 0, 0}};
    const Polynomial third{{1, -3, 0, 0}};
    std::vector<Root> roots = roots_in_unit_interval(close * third);
    ASSERT_EQ(roots.size(), 2u);
    EXPECT_EQ(compare(roots[0], roots[1]), -1);
    EXPECT_EQ(roots[0].sign_of(third), 1);
    EXPECT_EQ(roots[1].sign_of(close), -1);
    Root tiny = roots_in_unit_interval({{-1, Integer(1) << 1500, 0, 0}}).at(0);
    EXPECT_EQ(tiny.bracket(), (std::array<double, 2>{0, 0x1p-1074}));
    Root two_to_minus_1074 = roots_in_unit_interval({{-1, Integer(1) << 1074, 0, 0}}).at(0);
    EXPECT_EQ(two_to_minus_1074.bracket(), (std::array<double, 2>{0x1p-1074, 0x1p-1074}));
    EXPECT_EQ(compare(tiny, two_to_minus_1074), -1);
}

TEST(PolynomialRoots, ThreeInOneDeepCell) {
    // 2^-5000 (1, 2, 3) / 7 + 1/3: further apart from 0 and 1 than any stack is deep.
    const Integer far = Integer(1) << 5000;
    const auto near_third = [&](int k) { return Polynomial{{-(7 * far + 3 * k), 21 * far, 0, 0}}; };
    std::vector<Root> roots = roots_in_unit_interval(near_third(1) * near_third(2) * near_third(3));
    ASSERT_EQ(roots.size(), 3u);
    for (int k = 0; k < 3; ++k) {
        Root& root = roots[static_cast<std::size_t>(k)];
        for (int other = 0; other < 4; ++other)
            EXPECT_EQ(root.sign_of(near_third(other)), k + 1 > other ? 1 : k + 1 < other ? -1 : 0);
        Root alone = roots_in_unit_interval(near_third(k + 1)).at(0);
        EXPECT_EQ(compare(root, alone), 0);
    }
    EXPECT_EQ(compare(roots[0], roots[2]), -1);
    EXPECT_EQ(compare(roots[2], roots[1]), 1);
}

TEST(PolynomialRoots, SortedComparisonIsAnOrder) {
    std::mt19937_64 random(5);
    std::uniform_int_distribution<long> coefficient(-6, 6);
    std::vector<Root> all;
    while (all.size() < 60) {
        const Polynomial f{
            {coefficient(random), coefficient(random), coefficient(random), coefficient(random)}};
        for (const Root& root : roots_in_unit_interval(f))
            all.push_back(root);
    }
    for (Root& a : all)
        for (Root& b : all) {
            const int order = compare(a, b);
            EXPECT_EQ(compare(b, a), -order);
            // Where doubles tell, they agree.
            const auto x = a.bracket(), y = b.bracket();
            if (x[1] < y[0] || x[0] > y[1]) {
                EXPECT_EQ(order, x[1] < y[0] ? -1 : 1);
            }
        }
}

} // namespace
} // namespace boxwood::oracle
