#include "kernels/primitives/aabb.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>
#include <vector>

namespace boxwood {
namespace {

using Box = Aabb<float>;
constexpr float nan_f = std::numeric_limits<float>::quiet_NaN();
constexpr float inf_f = std::numeric_limits<float>::infinity();
constexpr Box unit{{0, 0, 0}, {1, 1, 1}};

/// All boxes with corners on the lattice {0, 1, 2}^3, flat ones among them: 6^3.
std::vector<Box> lattice_boxes() {
    std::vector<Box> all;
    const std::vector<std::pair<float, float>> ranges{{0, 0}, {0, 1}, {0, 2},
                                                      {1, 1}, {1, 2}, {2, 2}};
    for (const auto& x : ranges)
        for (const auto& y : ranges)
            for (const auto& z : ranges)
                all.push_back({{x.first, y.first, z.first}, {x.second, y.second, z.second}});
    return all;
}

TEST(Aabb, OverlapIsASharedLatticePoint) {
    const std::vector<Box> all = lattice_boxes();
    for (const Box& a : all)
        for (const Box& b : all) {
            bool shared = false; // lattice boxes that share a point share a lattice point
            for (int p = 0; p < 27 && !shared; ++p) {
                const Vec3<float> point{static_cast<float>(p % 3), static_cast<float>(p / 3 % 3),
                                        static_cast<float>(p / 9)};
                shared = a.contains(point) && b.contains(point);
            }
            ASSERT_EQ(overlaps(a, b), shared);
        }
}

TEST(Aabb, ContainmentAndMergeOnTheLattice) {
    const std::vector<Box> all = lattice_boxes();
    for (const Box& a : all)
        for (const Box& b : all) {
            const Box both = merge(a, b);
            ASSERT_TRUE(both.contains(a) && both.contains(b) && both.is_valid());
            ASSERT_EQ(both, merge(b, a));
            ASSERT_EQ(a.contains(b), both == a);
            ASSERT_GE(both.half_area(), a.half_area());
        }
}

TEST(Aabb, SetsAreClosed) {
    EXPECT_TRUE(overlaps(unit, Box{{1, 1, 1}, {2, 2, 2}}));
    EXPECT_FALSE(overlaps(unit, Box{{std::nextafter(1.0f, 2.0f), 0, 0}, {2, 1, 1}}));
    EXPECT_TRUE(unit.contains(Vec3<float>{1, 0, 1}));
    EXPECT_TRUE(overlaps(Box{{-0.0f, 0, 0}, {0.0f, 1, 1}}, Box{{0.0f, 0, 0}, {1, 1, 1}}));
    EXPECT_TRUE(overlaps(Box{{-1, 0, 0}, {-0.0f, 1, 1}}, unit));
}

TEST(Aabb, FlatBoxesHoldTheirPoints) {
    const Box point{{.5f, .5f, .5f}, {.5f, .5f, .5f}};
    EXPECT_TRUE(point.is_valid());
    EXPECT_FALSE(point.is_empty());
    EXPECT_TRUE(overlaps(point, unit));
    EXPECT_TRUE(overlaps(point, point));
    EXPECT_TRUE(unit.contains(point));
    EXPECT_EQ(point.half_area(), 0);
    EXPECT_EQ((Box{{0, 0, 0}, {2, 3, 0}}).half_area(), 6);
}

TEST(Aabb, TheEmptyBox) {
    const Box empty;
    const Box everything{{-inf_f, -inf_f, -inf_f}, {inf_f, inf_f, inf_f}};
    EXPECT_TRUE(empty.is_empty());
    EXPECT_FALSE(empty.is_valid());
    EXPECT_FALSE(overlaps(empty, empty));
    EXPECT_FALSE(overlaps(empty, unit));
    EXPECT_FALSE(overlaps(unit, empty));
    EXPECT_FALSE(overlaps(empty, Box{{-FLT_MAX, -FLT_MAX, -FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}}));
    EXPECT_TRUE(everything.contains(empty));
    EXPECT_EQ(empty.half_area(), 0);
    for (const Box& box : lattice_boxes()) {
        EXPECT_EQ(merge(empty, box), box);
        EXPECT_EQ(merge(box, empty), box);
    }
    EXPECT_EQ(merge(empty, empty), empty);
}

TEST(Aabb, NanOverlapsNothing) {
    for (int k = 0; k < 6; ++k) {
        Box box = unit;
        (k < 3 ? box.min : box.max)[k % 3] = nan_f;
        EXPECT_FALSE(overlaps(box, unit)) << k;
        EXPECT_FALSE(overlaps(unit, box)) << k;
        EXPECT_FALSE(overlaps(box, box)) << k;
        EXPECT_FALSE(box.is_valid()) << k;
        EXPECT_FALSE(unit.contains(box)) << k;
    }
    EXPECT_FALSE(unit.contains(Vec3<float>{.5f, nan_f, .5f}));
}

TEST(Aabb, OnlyFiniteUprightBoxesAreValid) {
    EXPECT_TRUE(unit.is_valid());
    for (int k = 0; k < 3; ++k) {
        Box inverted = unit, infinite = unit;
        inverted.min[k] = 2;
        infinite.max[k] = inf_f;
        EXPECT_FALSE(inverted.is_valid());
        EXPECT_TRUE(inverted.is_empty());
        EXPECT_FALSE(infinite.is_valid());
        EXPECT_FALSE(infinite.is_empty());
    }
}

TEST(Aabb, HalfAreaDoesNotOverflow) {
    const Box huge{{-FLT_MAX, -FLT_MAX, -FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}};
    const double side = 2 * static_cast<double>(FLT_MAX);
    EXPECT_EQ(huge.half_area(), 3 * side * side);
    EXPECT_EQ((Box{{1, 2, 3}, {3, 5, 8}}).half_area(), 2 * 3 + 3 * 5 + 5 * 2);
}

} // namespace
} // namespace boxwood
