#include "kernels/oracle/exact_answers.h"
#include "kernels/testing/grid_hulls.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace boxwood::oracle {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

struct GridRay {
    Grid origin, direction;
    int t_min, t_max; // 1000 instead of infinity, beyond everything
    Ray<float> ray() const {
        return {static_cast<Vec3<float>>(point(origin)), static_cast<Vec3<float>>(point(direction)),
                static_cast<float>(t_min), t_max == 1000 ? inf : static_cast<float>(t_max)};
    }
    Grid at(int t) const {
        return {origin[0] + t * direction[0], origin[1] + t * direction[1],
                origin[2] + t * direction[2]};
    }
};

GridRay random_ray(std::mt19937_64& random, int side) {
    for (;;) {
        const auto p = random_points(random, 2, side);
        const Grid d = minus(p[1], p[0]);
        const int t_min = static_cast<int>(random() % 3), length = static_cast<int>(random() % 3);
        if (d != Grid{0, 0, 0})
            return {p[0], d, t_min, random() % 2 ? 1000 : t_min + length};
    }
}

TEST(OracleRays, TrianglesAreHitAsTheirDifferencesSay) {
    std::mt19937_64 random(11);
    int hits = 0;
    for (int i = 0; i < 8000; ++i) {
        const auto t = random_points(random, 3, 4);
        const GridRay r = random_ray(random, 4);
        const auto n = normal(minus(t[1], t[0]), minus(t[2], t[0]));
        const bool crosses = product(n, r.direction) != 0;
        const bool truth = crosses && hull_to_hull({r.at(r.t_min), r.at(r.t_max)}, t).num == 0;
        const Triangle<double> wide = triangle(t);
        const auto hit = ray_triangle(r.ray(), {static_cast<Vec3<float>>(wide.a),
                                                static_cast<Vec3<float>>(wide.b),
                                                static_cast<Vec3<float>>(wide.c)});
        ASSERT_EQ(hit.has_value(), truth) << i;
        if (!hit)
            continue;
        ++hits;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto x = [&](const Grid& g) { return mpq_class(static_cast<long>(g[k])); };
            const mpq_class on_ray = x(r.origin) + hit->t * x(r.direction);
            const mpq_class on_triangle =
                (1 - hit->u - hit->v) * x(t[0]) + hit->u * x(t[1]) + hit->v * x(t[2]);
            ASSERT_EQ(on_ray, on_triangle) << i;
        }
    }
    EXPECT_GT(hits, 400);
}

TEST(OracleRays, BoxesAreMetAsTheirDifferencesSay) {
    std::mt19937_64 random(12);
    int hits = 0;
    for (int i = 0; i < 1500; ++i) {
        const auto ends = random_points(random, 2, 4);
        Aabb<float> box;
        box.extend(static_cast<Vec3<float>>(point(ends[0])));
        box.extend(static_cast<Vec3<float>>(point(ends[1])));
        std::vector<Grid> corners;
        for (std::size_t k = 0; k < 8; ++k)
            corners.push_back({ends[k & 1][0], ends[(k >> 1) & 1][1], ends[k >> 2][2]});
        const GridRay r = random_ray(random, 4);
        const bool truth = hull_to_hull({r.at(r.t_min), r.at(r.t_max)}, corners).num == 0;
        hits += truth;
        ASSERT_EQ(ray_box(r.ray(), box), truth) << i;
    }
    EXPECT_GT(hits, 200);
}

TEST(OracleRays, KnownAnswers) {
    // hard-cases.md 5: small triangles, far below any absolute epsilon.
    for (const float s : {1.0f, 5e-4f, 1e-8f, 0x1p-149f * 4}) {
        const Triangle<float> t{{0, 0, 0}, {s, 0, 0}, {0, s, 0}};
        const auto hit = ray_triangle({{s / 4, s / 4, -1}, {0, 0, 1}}, t);
        ASSERT_TRUE(hit) << s;
        EXPECT_EQ(hit->t, 1);
        EXPECT_EQ(hit->u, mpq_class(1, 4));
        EXPECT_EQ(hit->v, mpq_class(1, 4));
    }
    const Triangle<float> t{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_FALSE(ray_triangle({{-1, 0, 0}, {1, 0, 0}}, t));                    // in its plane
    EXPECT_TRUE(ray_triangle({{0, 0, -1}, {0, 0, 1}}, t));                     // a corner
    EXPECT_TRUE(ray_triangle({{0, 0, -1}, {0, 0, 1}, 1, 1}, t));               // both limits
    EXPECT_FALSE(ray_triangle({{0, 0, -1}, {0, 0, 1}, 0, 0x1.fffffep-1f}, t)); // just before
    EXPECT_FALSE(ray_triangle({{0, 0, 1}, {0, 0, 1}}, t));                     // behind
    EXPECT_FALSE(ray_box({{0, 0, 0}, {1, 0, 0}}, {}));                         // the empty box
    // numerics.md 4: meets the box in one point only, its edge.
    const Ray<float> ray{{-0x1.b83e5p+22f, -0x1.df1e88p+21f, 0},
                         {0x1.8c6eb8p+23f, 0x1.0d41f6p+23f, 0}};
    EXPECT_TRUE(ray_box(ray, {{0x1.cd3ce8p+46f, 0, -1}, {0x1p+60f, 0x1.39460cp+46f, 1}}));
    const float past = std::nextafter(0x1.39460cp+46f, 0.0f);
    EXPECT_FALSE(ray_box(ray, {{0x1.cd3ce8p+46f, 0, -1}, {0x1p+60f, past, 1}}));
}

} // namespace
} // namespace boxwood::oracle
