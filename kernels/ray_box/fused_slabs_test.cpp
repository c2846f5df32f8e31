#include "kernels/ray_box/fused_slabs.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace boxwood {
namespace {

using Box = Aabb<float>;
constexpr float inf = std::numeric_limits<float>::infinity();

/// The same without fusing: what SIMD targets that have no fused product compute.
RaySpan clip_unfused(const FusedSlabs& ray, const Box& box, float t_min, float t_max) {
    for (int k = 0; k < 3; ++k) {
        const bool negative = std::signbit(ray.rdir[k]);
        const float near = negative ? box.max[k] : box.min[k];
        const float far = negative ? box.min[k] : box.max[k];
        const float a = near * ray.rdir[k], b = far * ray.rdir[k];
        t_min = std::max(t_min, a - ray.entry_shift[k]);
        t_max = std::min(t_max, b - ray.exit_shift[k]);
    }
    return {t_min, t_max};
}

/// A ray with a corner, edge or face of a flat or thick box put on it as nearly as floats can, at
/// small integers so that it is there exactly.
TEST(FusedSlabs, NeverMissWhatTheRayTouchesExactly) {
    std::mt19937_64 random(4);
    const auto integer = [&](int low, int high) {
        return std::uniform_int_distribution(low, high)(random);
    };
    int zero_components = 0;
    for (int i = 0; i < 300000; ++i) {
        // origin + t direction is exact: 12 bits each, then scaled by powers of two.
        const int far_off = i % 3 == 0 ? 2000 : 8;
        const float scale = std::ldexp(1.0f, integer(-60, 60));
        const float stretch = std::ldexp(1.0f, integer(-20, 20));
        Ray<float> ray;
        const auto t = static_cast<float>(integer(0, 2000));
        Box box, bounds;
        for (int k = 0; k < 3; ++k) {
            const int o = integer(-far_off, far_off),
                      d = integer(-2000, 2000) * (integer(0, 3) > 0);
            ray.origin[k] = scale * static_cast<float>(o);
            ray.direction[k] = d == 0 ? (i % 2 ? 0.0f : -0.0f) : stretch * static_cast<float>(d);
            const float at = ray.origin[k] + scale * static_cast<float>(d) * t;
            const int side = integer(0, 2); // the point is on the low side, on the high, inside
            const float size = scale * static_cast<float>(integer(0, 1) * integer(1, 100));
            box.min[k] = side == 0 ? at : at - size;
            box.max[k] = side == 1 ? at : at + size;
            bounds.min[k] = box.min[k] - scale * static_cast<float>(integer(0, 100));
            bounds.max[k] = box.max[k] + scale * static_cast<float>(integer(0, 100));
            zero_components += d == 0;
        }
        if (ray.direction == Vec3<float>{})
            continue;
        const float t_hit = t * (scale / stretch);
        const FusedSlabs slabs(ray, SlabBounds(bounds));
        for (const auto& [from, to] : {std::array{0.0f, inf}, {t_hit, t_hit}, {0.0f, t_hit}}) {
            for (const RaySpan span :
                 {clip(slabs, box, from, to), clip_unfused(slabs, box, from, to)}) {
                ASSERT_TRUE(span.hit()) << i;
                ASSERT_LE(span.entry, t_hit) << i;
                ASSERT_GE(span.exit, t_hit) << i;
            }
        }
    }
    EXPECT_GT(zero_components, 1000);
}

TEST(FusedSlabs, CullsWhatIsClearlyMissed) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-1, 1);
    const SlabBounds bounds(Box{{-1, -1, -1}, {1, 1, 1}});
    int missed = 0, missed_right = 0;
    for (int i = 0; i < 20000; ++i) {
        Ray<float> ray{{place(random), place(random), place(random)},
                       {place(random), place(random), place(random)}};
        if (i % 4 == 0)
            ray.direction[i / 4 % 3] = 0;
        const Vec3<float> c{place(random), place(random), place(random)};
        const Box box{c - Vec3<float>{.01f, .01f, .01f}, c + Vec3<float>{.01f, .01f, .01f}};
        // In doubles, against a box larger by 1e-4.
        double t0 = 0, t1 = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            const double o = static_cast<double>(ray.origin[k]),
                         d = static_cast<double>(ray.direction[k]);
            double a = (static_cast<double>(box.min[k]) - 1e-4 - o) / d;
            double b = (static_cast<double>(box.max[k]) + 1e-4 - o) / d;
            if (a > b)
                std::swap(a, b);
            t0 = std::max(t0, a);
            t1 = std::min(t1, b);
        }
        if (t0 <= t1)
            continue;
        ++missed;
        missed_right += !clip(FusedSlabs(ray, bounds), box, 0, inf).hit();
    }
    EXPECT_GT(missed, 10000);
    EXPECT_EQ(missed_right, missed);
}

TEST(FusedSlabs, EmptyBoxesAreNeverHitAndExtremesNeverMissed) {
    const Box bounds{{-1, -1, -1}, {1, 1, 1}};
    for (const float size : {1e-38f, 1e-20f, 1.0f, 1e20f, 1e38f})
        for (const float x : {-size, 0.0f, size}) {
            const Ray<float> ray{{0, 0, 0}, {x, size, -size}};
            const FusedSlabs slabs(ray, SlabBounds(bounds));
            EXPECT_FALSE(clip(slabs, Box{}, 0, inf).hit()) << size;
            EXPECT_TRUE(clip(slabs, bounds, 0, inf).hit()) << size;
        }
    const Ray<float> far_away{{1e38f, 0, 0}, {-1e38f, 0, 0}};
    EXPECT_TRUE(clip(FusedSlabs(far_away, SlabBounds(bounds)), bounds, 0, inf).hit());
}

} // namespace
} // namespace boxwood
