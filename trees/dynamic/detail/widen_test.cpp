#include "trees/dynamic/detail/widen.h"

#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <cfloat>

namespace boxwood {
using namespace detail;
namespace {

/// By long doubles, whose 64 bits hold every sum here that is not far beyond the margin.
TEST(Widen, NoFaceIsNearerThanTheMargin) {
    for (const BoxFamily& family : box_families())
        for (const double margin : {0., 1e-42, 1e-3, .7, 1e6, double{FLT_MAX} / 8}) {
            std::vector<Box> boxes = family.boxes, widened;
            boxes.push_back(Box{});
            widen_boxes(boxes, margin, widened, serial());
            ASSERT_EQ(widened.size(), boxes.size());
            EXPECT_EQ(widened.back(), Box{});
            for (std::size_t i = 0; i + 1 < boxes.size(); ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    const auto of = [](float x) { return static_cast<long double>(x); };
                    const float low = widened[i].min[axis], high = widened[i].max[axis];
                    EXPECT_TRUE(of(boxes[i].min[axis]) - of(low) >= margin || low == -FLT_MAX);
                    EXPECT_TRUE(of(high) - of(boxes[i].max[axis]) >= margin || high == FLT_MAX);
                }
        }
}

TEST(Widen, TheMedianSideIsThatOfMost) {
    std::vector<Box> boxes(101, Box{{0, 0, 0}, {1, 2, 3}});
    EXPECT_EQ(median_side(boxes), 2);
    for (std::size_t i = 0; i < 101; i += 3)
        boxes[i] = i % 2 ? Box{} : Box{{0, 0, 0}, {1e30f, 1e30f, 1e30f}};
    EXPECT_EQ(median_side(boxes), 2);
    EXPECT_EQ(median_side(std::vector<Box>(5)), 1);
    EXPECT_EQ(median_side(std::vector<Box>(5, Box{{1, 1, 1}, {1, 1, 1}})), double{FLT_MIN});
}

} // namespace
} // namespace boxwood
