#include "trees/dynamic/detail/step_sample.h"

#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace boxwood {
using namespace detail;
namespace {

/// n boxes of which all go by `step` along x and every seventh is listed, or all are.
std::size_t count_of_steps(std::size_t n, float step, bool all) {
    auto boxes = random_boxes(n, .01f, 1);
    StepSample sample;
    sample.start(boxes);
    std::vector<std::uint32_t> moved;
    for (std::uint32_t i = 0; i < n; i += all ? 1 : 7) {
        moved.push_back(i);
        boxes[i].min.x -= step;
    }
    std::size_t found = 0;
    for (const float seen : sample.follow(boxes, moved)) {
        EXPECT_TRUE(seen == 0 || std::abs(seen - step) < 1e-6f) << seen;
        found += seen > 0;
    }
    for (const float seen : sample.follow(boxes, {}))
        EXPECT_EQ(seen, 0);
    EXPECT_NEAR(static_cast<double>(found) * sample.items_each(), static_cast<double>(moved.size()),
                n > 512 ? .25 * static_cast<double>(moved.size()) : 1e-9);
    return found;
}

TEST(StepSample, TheStepsOfThoseThatMovedAreSeen) {
    for (const std::size_t n : {0u, 1u, 7u, 100u, 512u, 3000u, 100'000u})
        for (const bool all : {false, true})
            EXPECT_LE(count_of_steps(n, .25f, all), 512u);
}

TEST(StepSample, OneThatCameOrWentStepsWithoutEnd) {
    auto boxes = random_boxes(10, .1f, 1);
    boxes[3] = Box{};
    StepSample sample;
    sample.start(boxes);
    boxes[3] = boxes[4];
    boxes[8] = Box{};
    const std::uint32_t moved[] = {3, 8};
    const auto steps = sample.follow(boxes, moved);
    for (std::size_t i = 0; i < 10; ++i)
        EXPECT_EQ(steps[i], i == 3 || i == 8 ? std::numeric_limits<float>::infinity() : 0) << i;
}

} // namespace
} // namespace boxwood
