#include "trees/dynamic/detail/nearest_first.h"

#include "trees/executor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace boxwood::detail {
namespace {

/// Of a block's boxes those that overlap come by their centres, then the others by their gaps.
TEST(NearestFirst, OverlappingBoxesComeByTheirCentres) {
    const Box box{{-1, -1, -1}, {1, 1, 1}};
    std::vector<Box> boxes;
    for (const float x : {9.f, .5f, -.25f, 3.f, 1.75f, -6.f, 0.f, -1.5f})
        boxes.push_back({{x - 1, -1, -1}, {x + 1, 1, 1}});
    std::vector<std::uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    const PackedLayout tree = PackedLayout::of_order(boxes, order, serial());
    const float limit = std::numeric_limits<float>::infinity();
    std::vector<float> places;
    const auto note = [&](std::uint32_t item, std::uint32_t) {
        places.push_back(std::abs(boxes[item].min.x + 1));
        return true;
    };
    EXPECT_TRUE(NearestFirst(limit).near_box(tree, box, note));
    EXPECT_EQ(places, (std::vector<float>{0, .25f, .5f, 1.5f, 1.75f, 3, 6, 9}));
}

} // namespace
} // namespace boxwood::detail
