#include "trees/dynamic/detail/far_sample.h"

#include <gtest/gtest.h>

#include <functional>

namespace boxwood {
using namespace detail;
namespace {

Box cube(float x) { return {{x, 0, 0}, {x + 1, 1, 1}}; }

/// n unit cubes in one place, which reach 1; those that `goes` names go 5 along x.
struct Gone {
    std::size_t gone = 0, about = 0;

    Gone(std::size_t n, const std::function<bool(std::uint32_t)>& goes, float far = 5) {
        std::vector<Box> boxes(n, cube(0));
        FarSample sample;
        sample.start(boxes, 1);
        for (std::uint32_t item = 0; item < n; ++item)
            if (goes(item)) {
                boxes[item] = cube(far);
                ++gone;
            }
        about = sample.look(boxes).items;
    }
};

TEST(FarSample, OfFewItemsTheNumberIsExact) {
    for (const std::size_t n : {0u, 1u, 15u, 256u}) {
        const Gone some(n, [](std::uint32_t item) { return item % 7 == 0; });
        EXPECT_EQ(some.about, some.gone);
    }
}

TEST(FarSample, OfManyItemsTheNumberIsAboutRightWhateverThePattern) {
    constexpr std::size_t n = 100'000;
    const std::function<bool(std::uint32_t)> patterns[] = {
        [](std::uint32_t item) { return item % 16 == 0; },
        [](std::uint32_t item) { return item % 16 == 9; },
        [](std::uint32_t item) { return item % 64 < 4; },
        [](std::uint32_t item) { return item < n / 16; },
        [](std::uint32_t item) { return item >= n - n / 16; },
        [](std::uint32_t item) { return (item * 2246822519u >> 28) == 3; },
    };
    for (const auto& pattern : patterns) {
        const Gone some(n, pattern);
        EXPECT_NEAR(static_cast<double>(some.about), static_cast<double>(some.gone), 0.25 * n / 16);
    }
    EXPECT_EQ(Gone(n, [](std::uint32_t) { return false; }).about, 0u);
    EXPECT_EQ(Gone(n, [](std::uint32_t) { return true; }).about, n);
}

TEST(FarSample, FarIsFartherThanTheReach) {
    const auto all = [](std::uint32_t) { return true; };
    EXPECT_EQ(Gone(100, all, 1.f).about, 0u);
    EXPECT_EQ(Gone(100, all, 1.01f).about, 100u);
}

TEST(FarSample, WhoCameOrWentIsFar) {
    std::vector<Box> boxes(10, cube(0));
    boxes[3] = Box{};
    FarSample sample;
    sample.start(boxes, 1);
    EXPECT_EQ(sample.look(boxes).items, 0u);
    boxes[3] = cube(0);
    boxes[7] = Box{};
    EXPECT_EQ(sample.look(boxes).items, 2u);
}

TEST(FarSample, TheMotionOfThoseWhoWentFarIsSharedOut) {
    std::vector<Box> boxes(10, cube(0));
    FarSample sample;
    sample.start(boxes, 1);
    for (std::size_t i = 0; i < 10; ++i)
        boxes[i] = cube(i == 0 ? 2 : .5f);
    EXPECT_EQ(sample.look(boxes).items, 1u);
    EXPECT_DOUBLE_EQ(sample.look(boxes).share, 2 / 6.5);
    boxes[0] = cube(1000); // counts as 4
    EXPECT_DOUBLE_EQ(sample.look(boxes).share, 4 / 8.5);
    sample.start_far(boxes);
    EXPECT_EQ(sample.look(boxes).items, 0u);
    boxes[1] = cube(1.5f); // since the start
    EXPECT_EQ(sample.look(boxes).items, 1u);
    EXPECT_DOUBLE_EQ(sample.look(boxes).share, 1.5 / 5.5);
}

} // namespace
} // namespace boxwood
