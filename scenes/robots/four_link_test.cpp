#include "scenes/robots/four_link.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace boxwood {
namespace {

using testing::ElementsAre;
using testing::Pair;

std::vector<std::pair<int, int>> overlapping(const std::array<Aabb<float>, 4>& boxes) {
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j)
            if (overlaps(boxes[static_cast<std::size_t>(i)], boxes[static_cast<std::size_t>(j)]))
                pairs.emplace_back(i, j);
    return pairs;
}

TEST(FourLink, StraightHasTwoPairsAndTheStatedBoxes) {
    const auto boxes = four_link_straight_boxes();
    EXPECT_THAT(overlapping(boxes), ElementsAre(Pair(0, 1), Pair(2, 3)));
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3<double> centre{four_link_centres[i], 0, 0};
        const Vec3<float> low(centre - four_link_half), high(centre + four_link_half);
        for (int axis = 0; axis < 3; ++axis) { // the next float outward, at most
            EXPECT_LE(boxes[i].min[axis], low[axis]);
            EXPECT_GE(boxes[i].min[axis], std::nextafter(low[axis], -9.f));
            EXPECT_GE(boxes[i].max[axis], high[axis]);
            EXPECT_LE(boxes[i].max[axis], std::nextafter(high[axis], 9.f));
        }
    }
}

TEST(FourLink, ZeroAnglesGiveTheStraightBoxesToTheBit) {
    EXPECT_EQ(four_link_boxes(four_link_straight), four_link_straight_boxes());
}

TEST(FourLink, BentMeetsAtItsJointsAlone) {
    EXPECT_THAT(overlapping(four_link_boxes(four_link_bent)),
                ElementsAre(Pair(0, 1), Pair(1, 2), Pair(2, 3)));
}

TEST(FourLink, FoldedTheWristMeetsTheBase) {
    EXPECT_THAT(overlapping(four_link_boxes(four_link_folded)),
                ElementsAre(Pair(0, 1), Pair(0, 3), Pair(1, 2), Pair(2, 3)));
}

// A corner of the wrist by complex numbers in long double, link by link.
TEST(FourLink, BoxesHoldEveryCornerOfTheTurnedLinks) {
    for (int k = 0; k < 2000; ++k) {
        const FourLinkAngles angles{0.1 * k, -0.37 * k, 1.3 + 0.011 * k};
        const auto boxes = four_link_boxes(angles);
        for (std::size_t link = 0; link < 4; ++link) {
            Aabb<double> around;
            for (int corner = 0; corner < 8; ++corner) {
                long double x = four_link_centres[link] + (corner & 1 ? 1 : -1) * four_link_half.x;
                long double y = (corner & 2 ? 1 : -1) * four_link_half.y;
                for (std::size_t j = link; j-- > 0;) { // turn about the joints, the last one first
                    const long double c = std::cos(static_cast<long double>(angles[j])),
                                      s = std::sin(static_cast<long double>(angles[j]));
                    const long double dx = x - four_link_joints[j];
                    x = four_link_joints[j] + c * dx - s * y;
                    y = s * dx + c * y;
                }
                const Vec3<double> p{static_cast<double>(x), static_cast<double>(y),
                                     (corner & 4 ? 1 : -1) * four_link_half.z};
                around.extend(p);
                ASSERT_TRUE(
                    Aabb<double>({Vec3<double>(boxes[link].min), Vec3<double>(boxes[link].max)})
                        .contains(p));
            }
            for (int axis = 0; axis < 3; ++axis) { // and tight
                ASSERT_NEAR(static_cast<double>(boxes[link].min[axis]), around.min[axis], 1e-6);
                ASSERT_NEAR(static_cast<double>(boxes[link].max[axis]), around.max[axis], 1e-6);
            }
        }
    }
}

TEST(FourLink, RefusesAnglesThatAreNotFinite) {
    EXPECT_THROW(four_link_boxes({0, std::nan(""), 0}), std::invalid_argument);
    EXPECT_THROW(four_link_boxes({0, 0, std::numeric_limits<double>::infinity()}),
                 std::invalid_argument);
}

} // namespace
} // namespace boxwood
