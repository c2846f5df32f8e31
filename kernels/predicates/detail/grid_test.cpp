#include "kernels/predicates/detail/grid.h"
#include "kernels/testing/thinned.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

namespace boxwood {
namespace {

using namespace detail;

using Point = Vec3<double>;

using testing::thinned;

int truth3d(const std::array<Point, 4>& p) {
    std::array<std::array<mpq_class, 3>, 3> row;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            row[i][k] =
                mpq_class(p[i + 1][static_cast<int>(k)]) - mpq_class(p[0][static_cast<int>(k)]);
    const auto minor = [&](std::size_t k, std::size_t l) -> mpq_class {
        return row[0][k] * row[1][l] - row[0][l] * row[1][k];
    };
    return sgn(
        mpq_class(row[2][0] * minor(1, 2) + row[2][1] * minor(2, 0) + row[2][2] * minor(0, 1)));
}

int truth2d(const std::array<Point, 4>& p, int u, int v) {
    const auto d = [&](std::size_t i, int k) -> mpq_class {
        return mpq_class(p[i][k]) - mpq_class(p[0][k]);
    };
    return sgn(mpq_class(d(1, u) * d(2, v) - d(1, v) * d(2, u)));
}

std::array<const Point*, 4> pointers(const std::array<Point, 4>& p) {
    return {&p[0], &p[1], &p[2], &p[3]};
}

/// Whether every number on the axis is a multiple of 2^(e - bits + 1), 2^e the largest's power.
bool fits(const std::array<Point, 4>& points, int axis, int bits) {
    int top = -2000;
    for (const Point& p : points)
        if (p[axis] != 0)
            top = std::max(top, std::ilogb(p[axis]));
    return std::all_of(points.begin(), points.end(), [&](const Point& p) {
        const mpq_class unit =
            top - bits + 1 >= 0
                ? mpq_class(mpz_class(1) << static_cast<unsigned long>(top - bits + 1))
                : mpq_class(1, mpz_class(1) << static_cast<unsigned long>(bits - 1 - top));
        return mpq_class(mpq_class(p[axis]) / unit).get_den() == 1;
    });
}

struct Counts {
    int placed = 0, refused = 0, zero = 0;
};

/// Numbers of `significant` bits whose exponents lie in [-spread, 0], scaled by 2^scale.
template <std::size_t digits>
Counts compare(int significant, int spread, int scale, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto below = [&](int n) { return std::uniform_int_distribution(0, n - 1)(random); };
    const auto number = [&] {
        const auto m = static_cast<double>((random() | 1ull << 63) >> (64 - significant));
        return std::ldexp(below(2) == 0 ? m : -m, scale - significant - below(spread + 1));
    };
    Counts counts;
    for (int i = 0; i < 1000 / thinned; ++i) {
        std::array<Point, 4> p;
        for (Point& q : p)
            q = {number(), number(), number()};
        switch (below(4)) {
        case 0: // coplanar
            p[3] = p[below(2) == 0 ? 0 : 2];
            break;
        case 1: // one number in common, and perhaps nothing else
            for (Point& q : p)
                q.y = p[0].y;
            break;
        case 2: // all in the plane x = z
            for (Point& q : p)
                q.z = q.x;
        }
        Grid<digits, 4> grid;
        const bool placed = grid.place(pointers(p));
        (placed ? counts.placed : counts.refused)++;
        if (digits == 1) {
            EXPECT_EQ(placed, fits(p, 0, 60) && fits(p, 1, 60) && fits(p, 2, 60));
        }
        if (!placed)
            continue;
        const int expected = truth3d(p);
        counts.zero += expected == 0;
        EXPECT_EQ(grid.orient3d(0, 1, 2, 3), expected);
        EXPECT_EQ(grid.orient3d(0, 2, 1, 3), -expected);
        for (int u = 0; u < 3; ++u)
            EXPECT_EQ(grid.orient2d(u, (u + 1) % 3, 0, 1, 2), truth2d(p, u, (u + 1) % 3));
        if (::testing::Test::HasFailure())
            break;
    }
    return counts;
}

TEST(Grid, OneDigit) {
    for (const int scale : {0, -800, 800, 1023})
        for (const int significant : {1, 12, 24, 53}) {
            const Counts counts = compare<1>(significant, 7, scale, 1);
            EXPECT_EQ(counts.refused, 0);
            EXPECT_GT(counts.zero, 250 / thinned);
        }
    const Counts beyond = compare<1>(53, 9, 0, 2);
    EXPECT_GT(beyond.placed, 100 / thinned);
    EXPECT_GT(beyond.refused, 100 / thinned);
}

TEST(Grid, TwoDigits) {
    for (const int scale : {0, -1000, 800, 1023})
        for (const int significant : {1, 24, 53}) {
            const Counts counts = compare<2>(significant, 67, scale, 3);
            EXPECT_EQ(counts.refused, 0) << scale << ' ' << significant;
            EXPECT_GT(counts.zero, 250 / thinned);
        }
    const Counts beyond = compare<2>(53, 90, 0, 4);
    EXPECT_GT(beyond.placed, 100 / thinned);
    EXPECT_GT(beyond.refused, 100 / thinned);
}

/// The largest numbers of their width, where a carry too few would show.
TEST(Grid, NoDigitOverflows) {
    const auto check = [](auto grid, double largest) {
        const double next = std::nextafter(largest, 0);
        const double steps[] = {largest, -largest, next, -next};
        std::mt19937 random(5);
        for (int i = 0; i < 5000 / thinned; ++i) {
            std::array<Point, 4> p;
            for (Point& q : p)
                q = {steps[random() % 4], steps[random() % 4], steps[random() % 4]};
            ASSERT_TRUE(grid.place(pointers(p)));
            ASSERT_EQ(grid.orient3d(0, 1, 2, 3), truth3d(p));
            ASSERT_EQ(grid.orient2d(0, 1, 0, 1, 2), truth2d(p, 0, 1));
        }
    };
    check(Grid<1, 4>(), std::nextafter(0x1p60, 0));
    check(Grid<2, 4>(), std::nextafter(0x1p120, 0));
}

} // namespace
} // namespace boxwood
