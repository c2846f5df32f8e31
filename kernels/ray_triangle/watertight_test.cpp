#include "kernels/ray_triangle/watertight.h"

#include "kernels/ray_box/slabs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace boxwood {
namespace {

static_assert(RayKernel<Watertight>);

using Point = Vec3<float>;
constexpr float inf_f = std::numeric_limits<float>::infinity();

struct NoIntersect {
    static constexpr std::string_view name = "none";
    static constexpr KernelInfo info{};
    struct PerRay {};
    static PerRay prepare(const Ray<float>&);
};
static_assert(!RayKernel<NoIntersect>);

bool hits(const Ray<float>& ray, const Triangle<float>& triangle, RayHit& hit) {
    return Watertight::intersect(Watertight::prepare(ray), ray, triangle, ray.t_max, hit);
}

/// As a tree does it: each triangle behind its box.
bool hits_any(const Ray<float>& ray, const std::vector<Triangle<float>>& mesh) {
    const auto per_ray = Watertight::prepare(ray);
    const RaySlabs slabs(ray);
    RayHit hit;
    return std::any_of(mesh.begin(), mesh.end(), [&](const Triangle<float>& t) {
        return clip(slabs, t.bounds(), ray.t_min, ray.t_max).hit() &&
               Watertight::intersect(per_ray, ray, t, ray.t_max, hit);
    });
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

// --- Leaks

/// The UV sphere of `slices` x `stacks` quads, each cut in two; the poles are fans.
TriangleMesh uv_sphere(std::uint32_t slices, std::uint32_t stacks) {
    TriangleMesh mesh;
    constexpr double pi = std::numbers::pi;
    mesh.vertices = {{0, 0, 1}, {0, 0, -1}};
    for (std::uint32_t j = 1; j < stacks; ++j)
        for (std::uint32_t i = 0; i < slices; ++i) {
            const double a = pi * j / stacks, b = 2 * pi * i / slices;
            mesh.vertices.push_back(Point(
                Vec3<double>{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)}));
        }
    const auto at = [&](std::uint32_t j, std::uint32_t i) {
        return 2 + (j - 1) * slices + i % slices;
    };
    for (std::uint32_t i = 0; i < slices; ++i) {
        mesh.triangles.push_back({0, at(1, i), at(1, i + 1)});
        mesh.triangles.push_back({1, at(stacks - 1, i + 1), at(stacks - 1, i)});
        for (std::uint32_t j = 1; j + 1 < stacks; ++j) {
            mesh.triangles.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
            mesh.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
        }
    }
    return mesh;
}

TEST(Watertight, NoLeakAtAnyVertexOrEdgeOfASphere) {
    const TriangleMesh mesh = uv_sphere(24, 12);
    std::vector<Triangle<float>> triangles;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        triangles.push_back(mesh.triangle(i));
    std::mt19937 random(8);
    std::uniform_real_distribution<float> place(-.5f, .5f);
    int rays = 0;
    const auto shoot = [&](Point origin, Point target) {
        ++rays;
        return hits_any({origin, target - origin}, triangles);
    };
    for (int round = 0; round < 8; ++round) {
        const Point origin =
            round == 0 ? Point{} : Point{place(random), place(random), place(random)};
        for (const Point& vertex : mesh.vertices)
            ASSERT_TRUE(shoot(origin, vertex));
        for (const Triangle<float>& t : triangles)
            for (const float s : {.5f, .25f, .7f}) {
                ASSERT_TRUE(shoot(origin, t.a + s * (t.b - t.a)));
                ASSERT_TRUE(shoot(origin, t.b + s * (t.c - t.b)));
            }
    }
    EXPECT_GT(rays, 20000);
}

/// Triangles around `tip`, narrowed in x; seen from far up z they cover a star around the tip.
struct Fan {
    std::vector<Point> rim;
    Point tip;
    std::vector<Triangle<float>> triangles;
};

template <class Random> Fan random_fan(Random& random, float needle) {
    std::uniform_real_distribution<float> wobble(.5f, 1.5f);
    std::uniform_real_distribution<float> place(-1, 1);
    Fan fan;
    const Point centre{2 * place(random), 2 * place(random), 2 * place(random)};
    const int n = 3 + static_cast<int>(random() % 10);
    for (int i = 0; i < n; ++i) {
        const float angle =
            2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(n);
        const float radius = wobble(random);
        fan.rim.push_back(centre + Point{needle * radius * std::cos(angle),
                                         radius * std::sin(angle), .2f * place(random)});
    }
    fan.tip =
        centre + Point{.1f * needle * place(random), .1f * place(random), .1f * place(random)};
    for (std::size_t i = 0; i < fan.rim.size(); ++i)
        fan.triangles.push_back({fan.tip, fan.rim[i], fan.rim[(i + 1) % fan.rim.size()]});
    return fan;
}

TEST(Watertight, NoLeakThroughFans) {
    // The tip, and points of the inner edges close enough to it not to leave the fan by rounding.
    std::mt19937 random(9);
    std::uniform_real_distribution<float> place(-1, 1), along(0, .8f);
    int rays = 0, hits_per_tip = 0;
    for (int i = 0; i < 25000; ++i) {
        const float needle = i % 3 == 0 ? 1e-2f : 1.0f;
        const Fan fan = random_fan(random, needle);
        const float distance = i % 4 == 0 ? 100.0f : 3.0f;
        const Point origin =
            fan.tip + Point{.1f * needle * place(random), .1f * place(random), distance};
        const auto shoot = [&](Point target) {
            ++rays;
            return hits_any({origin, target - origin}, fan.triangles);
        };
        ASSERT_TRUE(shoot(fan.tip)) << i;
        for (std::size_t k = 0; k < 8; ++k) {
            const Point rim = fan.rim[k % fan.rim.size()];
            ASSERT_TRUE(shoot(fan.tip + along(random) * (rim - fan.tip))) << i;
        }
        RayHit hit;
        for (const Triangle<float>& t : fan.triangles)
            hits_per_tip += hits({origin, fan.tip - origin}, t, hit);
    }
    EXPECT_GE(rays, 200000);
    EXPECT_GT(hits_per_tip, 25000); // a shared vertex may be hit twice: no parity counting
}

TEST(Watertight, WhatItHitsItsBoxDoesNotLose) {
    // Flat triangles with two sides along the axes, which are edges of their box; rays at those
    // sides, a few ulp beside: some hit by the kernel's rounding alone.
    std::mt19937 random(13);
    std::uniform_real_distribution<float> place(-1, 1), along(0, 1);
    const auto about_one = [&] {
        return 1 + static_cast<float>(static_cast<int>(random() % 9) - 4) * FLT_EPSILON;
    };
    int hit_count = 0, beside = 0;
    for (int i = 0; i < 300000; ++i) {
        const Point a{place(random), place(random), 1 + along(random)};
        const Triangle<float> t{
            a, {a.x + place(random), a.y, a.z}, {a.x, a.y + place(random), a.z}};
        const Point origin{place(random), place(random), along(random)};
        Point d = t.a + along(random) * ((i % 2 ? t.b : t.c) - t.a) - origin;
        d = {d.x * about_one(), d.y * about_one(), d.z};
        RayHit hit;
        if (d.z < std::max(std::abs(d.x), std::abs(d.y)) || !hits({origin, d}, t, hit))
            continue;
        ++hit_count;
        ASSERT_TRUE(clip(RaySlabs({origin, d}), t.bounds(), 0, inf_f).hit()) << i;
        const Vec3<double> o(origin), e(d);
        const Vec3<double> p = o + e * ((static_cast<double>(a.z) - o.z) / e.z);
        const Aabb<float> box = t.bounds();
        beside += p.x < static_cast<double>(box.min.x) || p.x > static_cast<double>(box.max.x) ||
                  p.y < static_cast<double>(box.min.y) || p.y > static_cast<double>(box.max.y);
    }
    EXPECT_GT(hit_count, 20000);
    EXPECT_GT(beside, 1000);
}

// --- Scale

TEST(Watertight, SmallTriangles) {
    for (float s = 1; s >= 1e-15f; s /= 3) {
        const Triangle<float> triangle{{0, 0, 0}, {s, 0, 0}, {0, s, 0}};
        RayHit hit;
        ASSERT_TRUE(hits({{s / 3, s / 3, -1}, {0, 0, 1}}, triangle, hit)) << s;
        EXPECT_EQ(hit.t, 1);
        EXPECT_NEAR(hit.u, 1.0f / 3, 1e-6f);
        EXPECT_NEAR(hit.v, 1.0f / 3, 1e-6f);
        EXPECT_FALSE(hits({{s, s, -1}, {0, 0, 1}}, triangle, hit)) << s;
    }
}

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

// --- Contract

TEST(Watertight, TakesTheClosedRangeOfT) {
    const Triangle<float> t{{0, 0, 2}, {4, 0, 2}, {0, 4, 2}};
    Ray<float> ray{{1, 1, 0}, {0, 0, 1}};
    const auto per_ray = Watertight::prepare(ray);
    RayHit hit;
    EXPECT_TRUE(Watertight::intersect(per_ray, ray, t, 2, hit));
    EXPECT_EQ(hit.t, 2);
    EXPECT_EQ(hit.u, .25f);
    EXPECT_EQ(hit.v, .25f);
    EXPECT_EQ(hit.triangle, no_triangle);
    const RayHit before = hit;
    EXPECT_FALSE(Watertight::intersect(per_ray, ray, t, std::nextafter(2.0f, 0.0f), hit));
    ray.t_min = 2;
    EXPECT_TRUE(Watertight::intersect(per_ray, ray, t, inf_f, hit));
    ray.t_min = std::nextafter(2.0f, 3.0f);
    EXPECT_FALSE(Watertight::intersect(per_ray, ray, t, inf_f, hit));
    EXPECT_EQ(hit, before);
    ray = {{1, 1, 2}, {0, 0, -1}}; // the origin on the triangle, from the back
    EXPECT_TRUE(hits(ray, t, hit));
    EXPECT_EQ(hit.t, 0);
    EXPECT_FALSE(std::signbit(hit.t));
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

TEST(Watertight, DegenerateAndBadInputMisses) {
    const float nan_f = std::nanf("");
    const Triangle<float> good{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    const Ray<float> down{{1, 1, 1}, {0, 0, -1}};
    RayHit hit;
    ASSERT_TRUE(hits(down, good, hit));
    EXPECT_FALSE(hits(down, {{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}, hit));
    EXPECT_FALSE(hits(down, {{0, 1, 0}, {1, 1, 0}, {2, 1, 0}}, hit));
    EXPECT_FALSE(hits({{-1, 1, 0}, {1, 0, 0}}, good, hit)); // in the plane
    EXPECT_FALSE(hits({{1, 1, 1}, {0, 0, 0}}, good, hit));
    for (const float bad : {nan_f, inf_f, -inf_f})
        for (int k = 0; k < 3; ++k) {
            Ray<float> ray = down;
            Triangle<float> t = good;
            ray.origin[k] = bad;
            EXPECT_FALSE(hits(ray, good, hit)) << bad << k;
            ray = down;
            ray.direction[k] = bad;
            EXPECT_FALSE(hits(ray, good, hit)) << bad << k;
            t.b[k] = bad;
            EXPECT_FALSE(hits(down, t, hit)) << bad << k;
        }
}

} // namespace
} // namespace boxwood
