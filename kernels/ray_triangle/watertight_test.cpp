#include "kernels/ray_triangle/watertight.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace boxwood {
namespace {

static_assert(RayKernel<Watertight>);

using Point = Vec3<float>;
constexpr float inf_f = std::numeric_limits<float>::infinity();

bool hits(const Ray<float>& ray, const Triangle<float>& triangle, RayHit& hit) {
    return Watertight::intersect(Watertight::prepare(ray), ray, triangle, ray.t_max, hit);
}

// --- Against the truth on small integers, by signs of 3 x 3 determinants: no shear, no rounding.

using Lattice = Vec3<std::int64_t>;

std::int64_t det(Lattice a, Lattice b, Lattice c) { return dot(a, cross(b, c)); }

struct Truth {
    bool touches = false, inside = false; ///< the closed triangle; its interior
    bool in_plane = false;                ///< counts as a miss
    double t = 0, u = 0, v = 0;
};

/// Only t >= 0 counts.
Truth truth(Lattice o, Lattice d, Lattice a, Lattice b, Lattice c) {
    const std::int64_t wa = det(d, b - o, c - o), wb = det(d, c - o, a - o),
                       wc = det(d, a - o, b - o);
    const std::int64_t sum = wa + wb + wc;
    if (sum == 0)
        return {.in_plane = true};
    const std::int64_t s = sum > 0 ? 1 : -1;
    const std::int64_t height = det(a - o, b - a, c - a), depth = det(d, b - a, c - a);
    const double t = static_cast<double>(height) / static_cast<double>(depth);
    return {s * wa >= 0 && s * wb >= 0 && s * wc >= 0 && t >= 0,
            s * wa > 0 && s * wb > 0 && s * wc > 0 && t > 0,
            false,
            t,
            static_cast<double>(wb) / static_cast<double>(sum),
            static_cast<double>(wc) / static_cast<double>(sum)};
}

/// `directions` draws the direction's components.
template <class Draw> void compare_on_lattice(int n, bool shear_is_exact, Draw direction) {
    std::mt19937 random(7);
    std::uniform_int_distribution<std::int64_t> place(0, 8);
    int inside = 0, on_edge = 0, missed = 0;
    for (int i = 0; i < n; ++i) {
        const auto point = [&] { return Lattice{place(random), place(random), place(random)}; };
        const Lattice o = point(), a = point(), b = point(), c = point();
        const Lattice d{direction(random), direction(random), direction(random)};
        if (d == Lattice{})
            continue;
        const Truth expected = truth(o, d, a, b, c);
        RayHit hit;
        const bool got = hits({Point(o), Point(d)}, {Point(a), Point(b), Point(c)}, hit);
        if (shear_is_exact || expected.inside || (!expected.touches && !expected.in_plane)) {
            ASSERT_EQ(got, expected.touches) << i;
        }
        inside += expected.inside;
        on_edge += expected.touches && !expected.inside;
        missed += !expected.touches;
        if (got && expected.touches) {
            ASSERT_NEAR(static_cast<double>(hit.t), expected.t, 4e-6 * (1 + expected.t)) << i;
            ASSERT_NEAR(static_cast<double>(hit.u), expected.u, 4e-6) << i;
            ASSERT_NEAR(static_cast<double>(hit.v), expected.v, 4e-6) << i;
        }
    }
    EXPECT_GT(inside, n / 200);
    EXPECT_GT(on_edge, n / 1000);
    EXPECT_GT(missed, n / 2);
}

TEST(Watertight, ExactOnTheLatticeWhereTheShearIs) {
    compare_on_lattice(300000, true, [](std::mt19937& random) {
        const std::array<std::int64_t, 7> powers{-4, -2, -1, 0, 1, 2, 4};
        return powers[random() % powers.size()];
    });
}

TEST(Watertight, RightInsideAndOutsideOnTheLattice) {
    compare_on_lattice(300000, false, [](std::mt19937& random) {
        return std::uniform_int_distribution<std::int64_t>(-8, 8)(random);
    });
}

// --- Scale

TEST(Watertight, PowersOfTwoChangeNothing) {
    std::mt19937 random(10);
    std::uniform_real_distribution<float> place(-1, 1);
    int hit_count = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto point = [&] { return Point{place(random), place(random), place(random)}; };
        const Triangle<float> t{point(), point(), point()};
        const Ray<float> ray{point(), point()};
        RayHit plain;
        const bool expected = hits(ray, t, plain);
        hit_count += expected;
        // 2^-100: no component within 2^-26 of 1 becomes denormal; 2^124: sums stay below 2^126.
        for (const int g : {-100, -60, 60, 124})
            for (const int k : {-100, 0, 120}) {
                const float s = std::ldexp(1.0f, g), r = std::ldexp(1.0f, k);
                RayHit scaled;
                const bool got =
                    hits({ray.origin * s, ray.direction * r}, {t.a * s, t.b * s, t.c * s}, scaled);
                const float t_scaled = std::ldexp(plain.t, g - k);
                ASSERT_EQ(got, expected && t_scaled < inf_f) << i << ' ' << g << ' ' << k;
                if (got) {
                    ASSERT_EQ(scaled.t, t_scaled);
                    ASSERT_EQ(scaled.u, plain.u);
                    ASSERT_EQ(scaled.v, plain.v);
                }
            }
    }
    EXPECT_GT(hit_count, 100);
}

TEST(Watertight, WeightsAreOfBAndC) {
    const Triangle<float> t{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int mirrored = 0; mirrored < 2; ++mirrored) {
        const float s = mirrored ? -1.0f : 1.0f;
        RayHit hit;
        ASSERT_TRUE(
            hits({Point{.5f, .25f, .25f} - Point{1, 1, 1} * s, Point{1, 1, 1} * s}, t, hit));
        EXPECT_FLOAT_EQ(hit.u, .25f);
        EXPECT_FLOAT_EQ(hit.v, .25f);
        ASSERT_TRUE(
            hits({Point{.25f, .5f, .25f} - Point{1, 1, 1} * s, Point{1, 1, 1} * s}, t, hit));
        EXPECT_FLOAT_EQ(hit.u, .5f);
    }
}

} // namespace
} // namespace boxwood
