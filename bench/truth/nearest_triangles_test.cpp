#include "bench/truth/nearest_triangles.h"

#include "kernels/oracle/nearest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace boxwood::bench {
namespace {

using Triangles = std::vector<Triangle<double>>;

Triangles soup(std::size_t n, double extent, Vec3<double> at, std::mt19937& random) {
    std::uniform_real_distribution<double> place(-1, 1);
    const auto point = [&](double size) {
        return Vec3<double>{place(random), place(random), place(random)} * size;
    };
    Triangles all;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3<double> p = at + point(1);
        all.push_back({p + point(extent), p + point(extent), p + point(extent)});
    }
    return all;
}

double brute_force(const Triangles& a, const Triangles& b) {
    mpq_class least = -1;
    for (const Triangle<double>& s : a)
        for (const Triangle<double>& t : b)
            if (const mpq_class squared = oracle::nearest(s, t).squared;
                least < 0 || squared < least)
                least = squared;
    return std::sqrt(least.get_d());
}

TEST(NearestTriangles, AreThoseOfAllPairs) {
    std::mt19937 random(3);
    int touching = 0;
    for (const double extent : {.02, .3})
        for (const double x : {0., 1.5, 2.3, 9.}) {
            const Triangles a = soup(40, extent, {}, random);
            const Triangles b = soup(35, extent, {x, .2, -.1}, random);
            const double expected = brute_force(a, b);
            const NearestTriangles::Least least = NearestTriangles(a).to(NearestTriangles(b));
            EXPECT_LE(std::abs(least.distance - expected), 0x1p-40 * expected);
            EXPECT_LE(least.lo, expected * (1 + 0x1p-50));
            EXPECT_GE(least.lo, expected * (1 - 0x1p-39));
            touching += expected == 0;
            const auto at_most = [&](double d) {
                return NearestTriangles(a).to(NearestTriangles(b), d);
            };
            EXPECT_LE(std::abs(at_most(2 * expected).distance - expected), 0x1p-40 * expected);
            EXPECT_EQ(at_most(.5 * expected).distance, .5 * expected);
            EXPECT_GE(at_most(.5 * expected).lo, .5 * expected * (1 - 0x1p-39));
        }
    EXPECT_GT(touching, 0);
    EXPECT_LT(touching, 5);
}

/// A rough sheet of 2 (n - 1)^2 triangles, one unit wide, at a height.
Triangles sheet(int n, double height, double roughness, std::mt19937& random) {
    std::uniform_real_distribution<double> rough(height - roughness, height + roughness);
    std::vector<Vec3<double>> points;
    for (int i = 0; i < n * n; ++i)
        points.push_back({i % n / (n - 1.), i / n / (n - 1.), rough(random)});
    Triangles all;
    for (int y = 0; y + 1 < n; ++y)
        for (int x = 0; x + 1 < n; ++x) {
            const auto at = [&](int dx, int dy) {
                return points[static_cast<std::size_t>((y + dy) * n + x + dx)];
            };
            all.push_back({at(0, 0), at(1, 0), at(1, 1)});
            all.push_back({at(0, 0), at(1, 1), at(0, 1)});
        }
    return all;
}

TEST(NearestTriangles, OfParallelSheetsAreThoseOfAllPairs) {
    std::mt19937 random(5);
    for (const double roughness : {0., 1e-5, .003}) {
        const Triangles a = sheet(6, 0, roughness, random), b = sheet(6, .01, roughness, random);
        const double expected = brute_force(a, b);
        const NearestTriangles::Least least = NearestTriangles(a).to(NearestTriangles(b));
        EXPECT_LE(std::abs(least.distance - expected), 0x1p-40 * expected);
        EXPECT_LE(least.lo, expected * (1 + 0x1p-50));
    }
}

TEST(NearestTriangles, AreThoseOfWhereTheyAreNow) {
    std::mt19937 random(4);
    const Triangles a = soup(30, .1, {}, random), b = soup(30, .1, {3, 0, 0}, random);
    NearestTriangles moving(a);
    moving.move(b);
    const double expected = brute_force(a, b);
    EXPECT_NEAR(NearestTriangles(a).to(moving).distance, expected, 1e-12);
    EXPECT_EQ(NearestTriangles({}).to(moving).distance, std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace boxwood::bench
