#include "trees/updates/margins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>

namespace boxwood {
namespace {

Box cube(float x) { return {{x, 0, 0}, {x + 1, 1, 1}}; }

/// n unit cubes of which those that `goes` names go `far` along x; all are said to have moved.
struct Moving {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> moved, gone;
    Margins margins;

    Moving(std::size_t n, double share, float far, const std::function<bool(std::uint32_t)>& goes)
        : boxes(n, cube(0)), moved(n) {
        margins.start(boxes, share);
        std::iota(moved.begin(), moved.end(), 0u);
        for (const std::uint32_t item : moved)
            if (goes(item)) {
                boxes[item] = cube(far);
                gone.push_back(item);
            }
    }
    std::vector<std::uint32_t> left() {
        const auto found = margins.left(boxes, moved);
        return {found.begin(), found.end()};
    }
};

TEST(Margins, FindWhatWentFartherThanTheyReach) {
    const auto third = [](std::uint32_t item) { return item % 3 == 1; };
    Moving near(100, 2, 2, third), far(100, 2, 2.01f, third);
    EXPECT_TRUE(near.left().empty()); // touching the fat box is inside
    EXPECT_EQ(far.left(), far.gone);
    far.margins.follow(far.boxes, far.gone);
    EXPECT_TRUE(far.left().empty());
}

TEST(Margins, OfFewItemsTheNumberIsExact) {
    for (const std::size_t n : {0u, 1u, 15u, 4096u}) {
        Moving all(n, 1, 5, [](std::uint32_t item) { return item % 7 == 0; });
        EXPECT_EQ(all.margins.about_left(all.boxes, all.moved), all.gone.size());
    }
}

TEST(Margins, OfManyItemsTheNumberIsAboutRightWhateverThePattern) {
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
        Moving some(n, 1, 5, pattern);
        const double found = static_cast<double>(some.margins.about_left(some.boxes, some.moved));
        EXPECT_NEAR(found, static_cast<double>(some.gone.size()), 0.25 * n / 16);
    }
    Moving none(n, 1, 5, [](std::uint32_t) { return false; });
    EXPECT_EQ(none.margins.about_left(none.boxes, none.moved), 0u);
    Moving every(n, 1, 5, [](std::uint32_t) { return true; });
    EXPECT_EQ(every.margins.about_left(every.boxes, every.moved), n);
}

} // namespace
} // namespace boxwood
