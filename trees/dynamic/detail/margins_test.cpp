#include "trees/dynamic/detail/margins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>

namespace boxwood {
using namespace detail;
namespace {

Box unit_cube(float x) { return {{x, 0, 0}, {x + 1, 1, 1}}; }

/// n unit cubes of which those that `goes` names go `far` along x; all are said to have moved.
struct Moving {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> moved, gone;
    Margins margins;

    Moving(std::size_t n, double share, float far, const std::function<bool(std::uint32_t)>& goes)
        : boxes(n, unit_cube(0)), moved(n) {
        margins.start(boxes, share);
        std::iota(moved.begin(), moved.end(), 0u);
        for (const std::uint32_t item : moved)
            if (goes(item)) {
                boxes[item] = unit_cube(far);
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

} // namespace
} // namespace boxwood
