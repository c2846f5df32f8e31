#include "kernels/predicates/exact.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/testing/thinned.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace boxwood {
namespace {

using namespace detail;

using Point = Vec3<double>;

using testing::thinned;

std::array<mpq_class, 3> exact_difference(const Point& p, const Point& q) {
    return {mpq_class(p.x) - mpq_class(q.x), mpq_class(p.y) - mpq_class(q.y),
            mpq_class(p.z) - mpq_class(q.z)};
}

int truth(const Point& a, const Point& b, const Point& c, const Point& d) {
    const auto u = exact_difference(b, a), v = exact_difference(c, a), w = exact_difference(d, a);
    return sgn(mpq_class(w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) +
                         w[2] * (u[0] * v[1] - u[1] * v[0])));
}

int truth(const Point& a, const Point& b, const Point& c) {
    const auto u = exact_difference(b, a), v = exact_difference(c, a);
    return sgn(mpq_class(u[0] * v[1] - u[1] * v[0]));
}

struct Random {
    std::mt19937_64 engine{5};
    int below(int n) { return std::uniform_int_distribution(0, n - 1)(engine); }
    /// In (-1, 1), of `bits` bits.
    double fraction(int bits) {
        const auto m = static_cast<double>(engine() >> (64 - bits));
        return std::ldexp(below(2) == 0 ? m : -m, -bits);
    }
    /// Any finite double at all.
    double any() {
        for (;;)
            if (const double x = std::bit_cast<double>(engine()); std::isfinite(x))
                return x;
    }
};

/// How many of each sign were met, and how often the filter decided.
struct Tally {
    int below = 0, zero = 0, above = 0, filtered = 0;
};

void judge(Tally& tally, const Point& a, const Point& b, const Point& c, const Point& d) {
    const int three = truth(a, b, c, d), two = truth(a, b, c);
    (three < 0 ? tally.below : three > 0 ? tally.above : tally.zero)++;
    const Point2<double> a2{a.x, a.y}, b2{b.x, b.y}, c2{c.x, c.y};
    for (const bool flushing : {false, true}) {
        // The signs are taken under the mode, and judged outside it.
        int signs[6];
        {
            const DenormalFlushing mode(flushing);
            signs[0] = Exact::orient3d(a, b, c, d);
            signs[1] = Accumulated::orient3d(a, b, c, d);
            signs[2] = Filtered::orient3d(a, b, c, d);
            signs[3] = Exact::orient2d(a2, b2, c2);
            signs[4] = Accumulated::orient2d(a2, b2, c2);
            signs[5] = Filtered::orient2d(a2, b2, c2);
        }
        ASSERT_EQ(signs[0], three);
        ASSERT_EQ(signs[1], three);
        ASSERT_TRUE(signs[2] == three || signs[2] == undecided);
        ASSERT_EQ(signs[3], two);
        ASSERT_EQ(signs[4], two);
        ASSERT_TRUE(signs[5] == two || signs[5] == undecided);
        tally.filtered += signs[2] != undecided;
    }
}

std::string print(std::initializer_list<Point> points) {
    char text[100];
    std::string all;
    for (const Point& p : points) {
        std::snprintf(text, sizeof text, "(%a %a %a) ", p.x, p.y, p.z);
        all += text;
    }
    return all;
}

/// n quadruples made by `make(random, points)`.
template <class Make> Tally run(int n, Make make) {
    Random random;
    Tally tally;
    for (int i = 0; i < n / thinned; ++i) {
        std::array<Point, 4> p;
        make(random, p);
        judge(tally, p[0], p[1], p[2], p[3]);
        if (::testing::Test::HasFatalFailure()) {
            ADD_FAILURE() << print({p[0], p[1], p[2], p[3]});
            break;
        }
    }
    return tally;
}

template <class F> void for_each_coordinate(std::array<Point, 4>& points, F f) {
    for (Point& p : points)
        for (int k = 0; k < 3; ++k)
            p[k] = f();
}

TEST(Exact, GenericIsLeftToTheFilter) {
    const int n = 20000 / thinned;
    const Tally tally = run(n * thinned, [](Random& random, std::array<Point, 4>& p) {
        for_each_coordinate(p, [&] { return random.fraction(53); });
    });
    EXPECT_GT(tally.filtered, 2 * n - 20);
}

TEST(Exact, SmallIntegers) {
    const Tally tally = run(20000, [](Random& random, std::array<Point, 4>& p) {
        for_each_coordinate(p, [&] { return random.below(4) - 1.5; });
    });
    EXPECT_GT(tally.zero, 1000 / thinned);
    EXPECT_GT(tally.below, 1000 / thinned);
}

/// d in the plane of a, b, c or beside it by as little as can be: all widths of numbers.
TEST(Exact, NearThePlane) {
    const Tally tally = run(20000, [](Random& random, std::array<Point, 4>& p) {
        const int bits = 10 + random.below(44), scale = random.below(41) - 20;
        for_each_coordinate(p, [&] { return std::ldexp(random.fraction(bits), scale); });
        const double s = random.fraction(3), t = random.fraction(3);
        p[3] = p[0] + s * (p[1] - p[0]) + t * (p[2] - p[0]);
        if (random.below(2) == 0)
            p[3].x = std::nextafter(p[3].x, random.below(2) == 0 ? 1e300 : -1e300);
    });
    EXPECT_GT(tally.zero, 1500 / thinned);
    EXPECT_GT(tally.below, 1500 / thinned);
    EXPECT_GT(tally.above, 1500 / thinned);
}

/// The same at all scales, by axis, down to denormals.
TEST(Exact, ScaledByPowersOfTwo) {
    const Tally tally = run(15000, [](Random& random, std::array<Point, 4>& p) {
        for_each_coordinate(p, [&] { return random.below(9) - 4.0; });
        const bool each_axis = random.below(2) == 0;
        int scale = random.below(2040) - 1070;
        for (int k = 0; k < 3; ++k) {
            if (each_axis)
                scale = random.below(2040) - 1070;
            for (Point& q : p)
                q[k] = std::ldexp(q[k], scale);
        }
    });
    EXPECT_GT(tally.zero, 200 / thinned);
    EXPECT_GT(tally.above, 1000 / thinned);
}

TEST(Exact, MixedMagnitudes) {
    Tally tally = run(8000, [](Random& random, std::array<Point, 4>& p) {
        const int span = 1 << random.below(12);
        for_each_coordinate(p, [&] {
            return std::ldexp(random.fraction(53),
                              std::clamp(random.below(span) - span / 2, -1074, 1023));
        });
        if (random.below(2) == 0)
            p[3] = p[0];
    });
    EXPECT_GT(tally.zero, 1000 / thinned);
    tally = run(4000, [](Random& random, std::array<Point, 4>& p) {
        for_each_coordinate(p, [&] { return random.any(); });
    });
    EXPECT_GT(tally.below, 500 / thinned);
    // Huge and tiny on a lattice, so that the tiny decides.
    tally = run(8000, [](Random& random, std::array<Point, 4>& p) {
        const double steps[] = {0, 1, 0x1p-1074, 0x1p1023, -0x1p1023, 0x1p-500, 1e300, -1e-300};
        for_each_coordinate(p, [&] { return steps[random.below(8)]; });
    });
    EXPECT_GT(tally.zero, 30 / thinned);
    EXPECT_GT(tally.above, 100 / thinned);
}

TEST(Exact, LargestNumbers) {
    const double huge = std::numeric_limits<double>::max();
    const Tally tally = run(5000, [&](Random& random, std::array<Point, 4>& p) {
        for_each_coordinate(p, [&] {
            const double x = random.below(4) == 0 ? std::nextafter(huge, 0) : huge;
            return random.below(2) == 0 ? x : -x;
        });
    });
    EXPECT_GT(tally.zero, 100 / thinned);
    EXPECT_GT(tally.above, 100 / thinned);
}

TEST(Exact, NonFiniteIsUndecided) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()})
        for (int i = 0; i < 4; ++i)
            for (int k = 0; k < 3; ++k) {
                Point p[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}};
                p[i][k] = bad;
                EXPECT_EQ(Exact::orient3d(p[0], p[1], p[2], p[3]), undecided);
                EXPECT_EQ(Filtered::orient3d(p[0], p[1], p[2], p[3]), undecided);
                if (i < 3 && k < 2) {
                    EXPECT_EQ(Exact::orient2d({p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y}),
                              undecided);
                }
            }
}

/// c on the line of a and b, rounded, or beside it by as little as can be.
TEST(Exact, NearTheLine) {
    int zero = 0;
    run(20000, [&](Random& random, std::array<Point, 4>& p) {
        const int bits = 10 + random.below(44);
        for_each_coordinate(p, [&] { return random.fraction(bits); });
        const double t = random.fraction(1 + random.below(20));
        p[2] = p[0] + t * (p[1] - p[0]);
        if (random.below(2) == 0)
            p[2].y = std::nextafter(p[2].y, random.below(2) == 0 ? 1e300 : -1e300);
        zero += truth(p[0], p[1], p[2]) == 0;
    });
    EXPECT_GT(zero, 1500 / thinned);
}

TEST(Superaccumulator, CarriesRipple) {
    const Binary64 one(1);
    Superaccumulator sum;
    // All ones from bit 0 to 53 * 18 - 1, then one more.
    for (int i = 0; i < 18; ++i)
        sum.add(Binary64(std::ldexp(0x1p53 - 1, 53 * i)), one, one);
    EXPECT_EQ(sum.sign(), 1);
    sum.add(Binary64(std::ldexp(1.0, 53 * 18)), one, one, true);
    EXPECT_EQ(sum.sign(), -1);
    sum.add(one, one, one);
    EXPECT_EQ(sum.sign(), 0);
    sum.add(Binary64(0x1p-1074), Binary64(-0x1p-1074), Binary64(0x1p-1074));
    EXPECT_EQ(sum.sign(), -1);
}

/// The filter's bound is a bound, and no emptily wide one: random determinants next to it are
/// right, and those ten times above it are decided.
TEST(Filtered, IsSharp) {
    Random random;
    int decided = 0, n = 0;
    for (int i = 0; i < 50000 / thinned; ++i) {
        Point p[4];
        for (Point& q : p)
            q = {random.fraction(53), random.fraction(53), random.fraction(53)};
        const double s = random.fraction(10), t = random.fraction(10);
        p[3] = p[0] + s * (p[1] - p[0]) + t * (p[2] - p[0]);
        p[3].x += std::ldexp(random.fraction(20), -40 - random.below(14));
        const int sign = Filtered::orient3d(p[0], p[1], p[2], p[3]);
        n += 1;
        decided += sign != undecided;
        if (sign != undecided) {
            ASSERT_EQ(sign, truth(p[0], p[1], p[2], p[3])) << print({p[0], p[1], p[2], p[3]});
        }
    }
    EXPECT_GT(decided, n / 4);
    EXPECT_LT(decided, n);
}

} // namespace
} // namespace boxwood
