#include "trees/dynamic/detail/box_steps.h"

#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>

namespace boxwood {
using namespace detail;
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

TEST(BoxSteps, AscendingOrNot) {
    for (const std::size_t n : {0u, 1u, 2u, 15u, 16u, 17u, 18u, 50u}) {
        std::vector<std::uint32_t> items(n);
        for (std::uint32_t i = 0; i < n; ++i)
            items[i] = i < n / 2 ? 2 * i : 0xffff'0000u + i;
        EXPECT_TRUE(are_ascending(items));
        for (std::size_t i = 1; i < n; ++i) {
            auto wrong = items;
            wrong[i] = wrong[i - 1];
            EXPECT_FALSE(are_ascending(wrong)) << n << " " << i;
            wrong = items;
            std::swap(wrong[i], wrong[i - 1]);
            EXPECT_FALSE(are_ascending(wrong)) << n << " " << i;
        }
    }
}

TEST(BoxSteps, OfOneBox) {
    const Box box{{0, 0, 0}, {1, 1, 1}};
    EXPECT_EQ(box_step(box, box), 0);
    EXPECT_EQ(box_step({{0, 0, 0}, {1, 1.5f, 1.25f}}, box), .5f);
    EXPECT_EQ(box_step({{0, -3, 0}, {1, 1, 1}}, box), 3);
    EXPECT_EQ(box_step({{0, 0, 0}, {1, 1, 1}}, {{0x1p-149f, 0, 0}, {1, 1, 1}}), FLT_MIN);
    EXPECT_EQ(box_step(Box{}, box), inf);
    EXPECT_EQ(box_step(box, Box{}), inf);
    EXPECT_EQ(box_step(Box{}, Box{}), 0);
}

TEST(BoxSteps, BlocksAreFollowedAsBoxesOneByOne) {
    const std::size_t n = 83, blocks = 6;
    for (std::size_t who = 0; who < n; ++who)
        for (const float far : {0.f, .01f, .4f}) {
            const auto before = random_boxes(n, .2f, 4);
            auto now = before;
            for (std::size_t i = 0; i < n; i += 2)
                now[i].max.y += .05f;
            now[who].min.z -= far;
            now[(who + 20) % n] = far > 0 ? Box{} : now[(who + 20) % n];
            auto kept = before;
            std::vector<float> steps(blocks);
            std::vector<std::uint32_t> left(blocks);
            const std::size_t n_left =
                follow_blocks(now, kept.data(), 0, blocks, .2f, steps.data(), left.data());
            std::size_t expected_left = 0;
            for (std::size_t b = 0; b < blocks; ++b) {
                float step = 0;
                for (std::size_t i = b * 16; i < std::min(n, b * 16 + 16); ++i)
                    step = std::max(step, box_step(now[i], before[i]));
                EXPECT_EQ(steps[b], step);
                if (step > .2f) {
                    ASSERT_LT(expected_left, n_left);
                    EXPECT_EQ(left[expected_left++], b);
                }
                for (std::size_t i = b * 16; i < std::min(n, b * 16 + 16); ++i)
                    EXPECT_EQ(kept[i], step > .2f ? before[i] : now[i]);
            }
            EXPECT_EQ(n_left, expected_left);
        }
}

} // namespace
} // namespace boxwood
