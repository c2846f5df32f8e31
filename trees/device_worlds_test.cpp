/// Compiled twice: on a device if there is one, and on the host's model of one.

#include "trees/device.h"

#include "trees/testing/box_families.h"
#include "trees/testing/brute_force.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace boxwood {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

struct WorldsOnADevice : ::testing::Test {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> first{0};

    void SetUp() override {
        if (devices().empty())
            GTEST_SKIP() << why_no_device();
    }
    void add(const std::vector<Box>& world) {
        boxes.insert(boxes.end(), world.begin(), world.end());
        first.push_back(static_cast<std::uint32_t>(boxes.size()));
    }
    void expect(const DeviceWorlds& worlds, const std::vector<Box>& of) const {
        const AnswersOf<Pair> found = worlds.self_pairs();
        ASSERT_EQ(found.offsets.size(), first.size());
        for (std::size_t w = 0; w + 1 < first.size(); ++w) {
            std::vector<Pair> wanted =
                brute_force(Boxes(of).subspan(first[w], first[w + 1] - first[w]));
            for (Pair& pair : wanted)
                pair = {pair.a + first[w], pair.b + first[w]};
            std::vector<Pair> pairs(found[w].begin(), found[w].end());
            std::ranges::sort(pairs);
            EXPECT_EQ(pairs, wanted) << "world " << w;
        }
    }
};

TEST_F(WorldsOnADevice, HaveThePairsOfEachWorld) {
    for (std::uint32_t seed = 0; seed < 4; ++seed)
        for (const std::size_t n : {20u, 0u, 1u, 2u, 33u, 0u, 16u})
            add(random_boxes(n, .3f, seed));
    DeviceWorlds worlds(boxes, first);
    EXPECT_EQ(worlds.n_worlds(), 28u);
    EXPECT_EQ(worlds.size(), boxes.size());
    expect(worlds, boxes);
    const std::vector<Box> moved = random_boxes(boxes.size(), .4f, 9);
    worlds.update(moved);
    expect(worlds, moved);
    const DeviceArray<Box> there(std::span<const Box>(boxes), DevicePlace{});
    worlds.update(there.span());
    expect(worlds, boxes);
    const DeviceWorlds taken(there.span(), first);
    expect(taken, boxes);
}

TEST_F(WorldsOnADevice, ThousandsOfThemAreOneBuild) {
    const std::vector<Box> robot = random_boxes(3, .5f, 1);
    for (int w = 0; w < 4096; ++w)
        add(robot);
    const std::uint64_t before = launches_so_far();
    const DeviceWorlds worlds(boxes, first);
    EXPECT_LT(launches_so_far() - before, 10u);
    expect(worlds, boxes);
}

TEST_F(WorldsOnADevice, MayBeNoneAndEmpty) {
    expect(DeviceWorlds(boxes, first), boxes);
    for (int w = 0; w < 3; ++w)
        add({});
    expect(DeviceWorlds(boxes, first), boxes);
}

TEST_F(WorldsOnADevice, ThatAreBadAreRefused) {
    add(random_boxes(300, .2f, 1));
    DeviceWorlds worlds(boxes, first);
    std::vector<Box> bad = boxes;
    bad[70].min.y = std::numeric_limits<float>::quiet_NaN();
    bad[200].min.y = 10;
    try {
        worlds.update(bad);
        FAIL() << "no InvalidBox";
    } catch (const InvalidBox& error) {
        EXPECT_EQ(error.index, 70u);
    }
    EXPECT_EQ(worlds.size(), 0u);
    EXPECT_TRUE(worlds.self_pairs().of.empty());
    worlds.update(boxes);
    expect(worlds, boxes);
    EXPECT_THAT([&] { worlds.update(Boxes(boxes).first(9)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("by 9 boxes, where there are 300")));
    const auto made = [&](std::vector<std::uint32_t> begin) {
        return [this, begin = std::move(begin)] { DeviceWorlds(boxes, begin); };
    };
    EXPECT_THAT(made({}), ThrowsMessage<std::invalid_argument>(HasSubstr("begins with 0")));
    EXPECT_THAT(made({1, 300}), ThrowsMessage<std::invalid_argument>(HasSubstr("begins with 0")));
    EXPECT_THAT(made({0, 299}), ThrowsMessage<std::invalid_argument>(HasSubstr("the 300 boxes")));
    EXPECT_THAT(made({0, 9, 8, 300}),
                ThrowsMessage<std::invalid_argument>(HasSubstr("falls from 9 to 8 after world 1")));
}

TEST(Worlds, WithoutADeviceSayWhy) {
    if (devices().empty()) {
        EXPECT_THAT([] { DeviceWorlds(Boxes{}, std::vector<std::uint32_t>{0}); },
                    ThrowsMessage<DeviceError>("no CUDA device: " + why_no_device()));
    }
}

} // namespace
} // namespace boxwood
