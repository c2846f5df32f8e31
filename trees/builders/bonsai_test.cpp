#include "trees/builder.h"
#include "trees/inspect/quality.h"
#include "trees/inspect/validate.h"
#include "trees/testing/box_families.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

namespace boxwood {
namespace {

Tree bonsai(const std::vector<Box>& boxes, int group, double prune) {
    return find_builder("bonsai").make({{"group", group}, {"prune", prune}})(boxes, serial());
}

double cost(const Tree& tree, const std::vector<Box>& boxes) {
    return quality(tree, boxes).sah_cost;
}

TEST(BonsaiBuilder, MakesValidTreesOfManyMiniTreesPrunedOrNot) {
    for (const BoxFamily& family : box_families())
        for (const double prune : {0., .05, 1., 1e6}) {
            const Tree tree = bonsai(family.boxes, 16, prune);
            EXPECT_EQ(validate(tree, family.boxes).value_or(""), "") << family.name << " " << prune;
            if (tree.empty())
                continue;
            EXPECT_LE(quality(tree, family.boxes).depth_max,
                      6u * std::bit_width(family.boxes.size()) + 66)
                << family.name << " " << prune;
        }
}

TEST(BonsaiBuilder, HalvesItemsThatTheCurveCannotTellApart) {
    // One far box makes the cells so large that all others fall in one, of the fine curve even.
    std::vector<Box> boxes = random_boxes(3000, .1f, 12);
    boxes.push_back({{1e9f, 1e9f, 1e9f}, {1e9f, 1e9f, 1e9f}});
    const Tree tree = bonsai(boxes, 100, 1);
    EXPECT_EQ(validate(tree, boxes).value_or(""), "");
    EXPECT_LE(quality(tree, boxes).depth_max, 60u);

    const std::vector<Box> same(5000, Box{{0, 0, 0}, {1, 2, 3}});
    for (const double prune : {.5, 1.}) {
        const Tree even = bonsai(same, 64, prune);
        EXPECT_EQ(validate(even, same).value_or(""), "");
        EXPECT_LE(quality(even, same).depth_max, 20u) << prune;
    }
}

TEST(BonsaiBuilder, CostsLittleMoreThanBinnedSah) {
    const std::vector<Box> boxes = random_boxes(20000, .02f, 13);
    const double binned = cost(find_builder("binned_sah").make({})(boxes, serial()), boxes);
    EXPECT_LT(cost(bonsai(boxes, 256, 1), boxes), 1.02 * binned);
    EXPECT_LT(cost(bonsai(boxes, 16, 1), boxes), 1.06 * binned);
}

TEST(BonsaiBuilder, PruningPaysWhereBoxesOfManySizesMeet) {
    std::vector<Box> boxes = random_boxes(20000, .01f, 14);
    for (std::size_t i = 0; i < boxes.size(); i += 20)
        boxes[i].max = boxes[i].min + Vec3<float>{.3f, .2f, .25f};
    const double kept = cost(bonsai(boxes, 256, 1e6), boxes);
    EXPECT_LT(cost(bonsai(boxes, 256, .25), boxes), .95 * kept);
}

TEST(BonsaiBuilder, RefusesABadBoxByItsIndex) {
    std::vector<Box> boxes = random_boxes(2000, .1f, 15);
    boxes[1234].max.y = boxes[1234].min.y - 1;
    EXPECT_THAT([&] { bonsai(boxes, 64, 1); },
                testing::Throws<InvalidBox>(testing::Field(&InvalidBox::index, 1234u)));
}

} // namespace
} // namespace boxwood
