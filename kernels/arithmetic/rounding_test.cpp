#include "kernels/arithmetic/rounding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace boxwood {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr float inf_f = std::numeric_limits<float>::infinity();
constexpr float denorm = std::numeric_limits<float>::denorm_min();

/// An oracle without a conversion: the float's bits as an integer that grows with the value, found
/// by bisection with comparisons in double alone.
float by_bisection(double x) {
    const auto float_at = [](std::int64_t rank) {
        const auto bits = static_cast<std::uint32_t>(rank < 0 ? -rank - 1 : rank);
        return std::bit_cast<float>(rank < 0 ? bits | 0x80000000u : bits);
    };
    std::int64_t low = -std::int64_t{0x7f800000} - 1, high = 0x7f800000; // -inf .. +inf
    if (static_cast<double>(inf_f) <= x)
        return inf_f;
    while (high - low > 1) { // float_at(low) <= x < float_at(high)
        const std::int64_t middle = low + (high - low) / 2;
        (static_cast<double>(float_at(middle)) <= x ? low : high) = middle;
    }
    return float_at(low);
}

std::vector<double> awkward_doubles() {
    std::vector<double> all{0.0, 1.0, 0.1, 1.0 / 3, 1e-320, 5e-324, 1e-60, 1e300, DBL_MAX, inf};
    const std::array<float, 8> floats{denorm,        3 * denorm, FLT_MIN, 1.0f,
                                      0x1.fffffep0f, 0x1p23f,    0x1p24f, FLT_MAX};
    for (const float f : floats) {
        const double d = static_cast<double>(f);
        all.insert(all.end(), {d, std::nextafter(d, inf), std::nextafter(d, -inf), d * 1.5, d / 2,
                               d * (1 + 0x1p-25), d * (1 + 0x1p-24), d * (1 + 0x1p-23)});
    }
    std::mt19937_64 random(1);
    for (int i = 0; i < 20000; ++i) {
        const int exponent = static_cast<int>(random() % 320) - 170;
        all.push_back(std::ldexp(static_cast<double>(random() >> 11), exponent - 52));
    }
    const std::size_t n = all.size();
    for (std::size_t i = 0; i < n; ++i)
        all.push_back(-all[i]);
    return all;
}

TEST(Rounding, AgreesWithBisection) {
    for (const double x : awkward_doubles()) {
        EXPECT_EQ(round_down(x), by_bisection(x)) << std::hexfloat << x;
        EXPECT_EQ(round_up(x), -by_bisection(-x)) << std::hexfloat << x;
    }
}

TEST(Rounding, Ends) {
    EXPECT_EQ(round_down(1e300), FLT_MAX);
    EXPECT_EQ(round_up(1e300), inf_f);
    EXPECT_EQ(round_down(-1e300), -inf_f);
    EXPECT_EQ(round_up(-1e300), -FLT_MAX);
    EXPECT_EQ(round_down(inf), inf_f);
    EXPECT_EQ(round_up(-inf), -inf_f);
    EXPECT_EQ(round_down(1e-60), 0.0f);
    EXPECT_EQ(round_up(1e-60), denorm);
    EXPECT_EQ(round_down(-1e-60), -denorm);
    EXPECT_FALSE(std::signbit(round_down(0.0)));
    EXPECT_TRUE(std::signbit(round_down(-0.0)));
    EXPECT_TRUE(std::signbit(round_up(-0.0)));
    EXPECT_TRUE(std::isnan(round_down(std::nan(""))));
    EXPECT_TRUE(std::isnan(round_up(std::nan(""))));
}

TEST(Rounding, IsMonotone) {
    std::vector<double> all = awkward_doubles();
    std::sort(all.begin(), all.end());
    for (std::size_t i = 1; i < all.size(); ++i) {
        EXPECT_LE(round_down(all[i - 1]), round_down(all[i]));
        EXPECT_LE(round_up(all[i - 1]), round_up(all[i]));
    }
}

TEST(Rounding, BoxesKeepTheirOverlaps) {
    EXPECT_EQ(round_outward(Aabb<double>{}), Aabb<float>{});
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> place(-1, 1), size(0, 1);
    int overlapping = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto box = [&] {
            Vec3<double> p{place(random), place(random), place(random)};
            return Aabb<double>{p, p + Vec3<double>{size(random), size(random), size(random)}};
        };
        const Aabb<double> a = box();
        Aabb<double> b = box();
        if (i % 2 == 0) // exactly touching
            b = {{a.max.x, b.min.y, b.min.z}, {a.max.x + size(random), b.max.y, b.max.z}};
        const Aabb<float> fa = round_outward(a), fb = round_outward(b);
        const Aabb<double> back{Vec3<double>(fa.min), Vec3<double>(fa.max)};
        EXPECT_TRUE(back.contains(a));
        if (overlaps(a, b)) {
            ++overlapping;
            EXPECT_TRUE(overlaps(fa, fb));
        }
    }
    EXPECT_GT(overlapping, 1000);
}

// --- The compiler: g++ 12 at -O2 without -fno-tree-slp-vectorize drops the rounding of
// double(float(x)) when it packs neighbours into a vector. This fails if the flag is ever lost.

struct SplitMix {
    std::uint64_t state;
    double unit() {
        std::uint64_t z = state += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
};

bool is_float(double x) {
    return (std::bit_cast<std::uint64_t>(x) & ((std::uint64_t{1} << 29) - 1)) == 0;
}

Vec3<double> float_point(SplitMix& random) {
    const auto rounded = [&] { return static_cast<double>(static_cast<float>(random.unit())); };
    const double x = rounded(), y = rounded(), z = rounded();
    return {x, y, z};
}

TEST(Compiler, RoundsToFloatAndBack) {
    SplitMix random{2024};
    std::array<Vec3<double>, 3> corners;
    for (Vec3<double>& p : corners)
        p = float_point(random);
    const double u = random.unit(), v = random.unit();
    const Vec3<double> inside =
        corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
    for (const Vec3<double>& p : corners)
        EXPECT_TRUE(is_float(p.x) && is_float(p.y) && is_float(p.z))
            << std::hexfloat << p.x << ' ' << p.y << ' ' << p.z;
    EXPECT_GT(dot(inside, inside), 0);
}

} // namespace
} // namespace boxwood
