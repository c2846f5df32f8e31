/// Compiled twice: on a device if there is one, and on the host's model of one.

#include "trees/device.h"

#include "trees/testing/box_families.h"
#include "trees/testing/brute_force.h"
#include "trees/trees.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace boxwood {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr DeviceBuilder device_builders[] = {DeviceBuilder::hilbert, DeviceBuilder::lbvh,
                                             DeviceBuilder::hploc};

std::vector<Pair> sorted(std::vector<Pair> pairs) {
    std::ranges::sort(pairs);
    return pairs;
}

/// Equal for the same pairs in any order, and hardly for others: their number and a sum of hashes.
std::pair<std::size_t, std::uint64_t> in_any_order(std::span<const Pair> pairs) {
    std::uint64_t sum = 0;
    for (const Pair& pair : pairs) {
        std::uint64_t bits = std::uint64_t{pair.a} << 32 | pair.b;
        for (const std::uint64_t factor : {0xbf58476d1ce4e5b9u, 0x94d049bb133111ebu}) {
            bits = (bits ^ bits >> 30) * factor; // as splitmix64 mixes
            bits ^= bits >> 27;
        }
        sum += bits;
    }
    return {pairs.size(), sum};
}

std::vector<Pair> brute_force(Boxes a, Boxes b) {
    std::vector<Pair> pairs;
    for (std::uint32_t i = 0; i < a.size(); ++i)
        for (std::uint32_t j = 0; j < b.size(); ++j)
            if (overlaps(a[i], b[j]))
                pairs.push_back({i, j});
    return pairs;
}

class OnADevice : public ::testing::TestWithParam<DeviceBuilder> {
  protected:
    void SetUp() override {
        if (devices().empty())
            GTEST_SKIP() << why_no_device();
    }
    DeviceBvhOptions options() const { return {.builder = GetParam(), .place = {}}; }
};
INSTANTIATE_TEST_SUITE_P(Device, OnADevice, ::testing::ValuesIn(device_builders),
                         [](const auto& test) {
                             return test.param == DeviceBuilder::hilbert ? "hilbert"
                                    : test.param == DeviceBuilder::lbvh  ? "lbvh"
                                                                         : "hploc";
                         });

TEST_P(OnADevice, SelfPairsAreThoseOfBruteForce) {
    std::vector<BoxFamily> families = box_families();
    for (const std::size_t n : {0u, 1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 4097u})
        families.push_back(
            {"random " + std::to_string(n), random_boxes(n, n > 1000 ? .05f : .2f, 5)});
    for (const BoxFamily& family : families) {
        if (GetParam() == DeviceBuilder::hploc && family.boxes.size() > 5000)
            continue; // the model of a device is slow
        SCOPED_TRACE(family.name);
        const std::vector<Pair> wanted = boxwood::brute_force(family.boxes);
        const DeviceBvh bvh(family.boxes, options());
        EXPECT_EQ(bvh.size(), family.boxes.size());
        EXPECT_EQ(bvh.self_pair_count(), wanted.size());
        const std::vector<Pair> found = bvh.self_pairs();
        EXPECT_EQ(sorted(found), wanted);
        EXPECT_EQ(bvh.self_pairs_on_device().to_host(), found);
    }
}

TEST_P(OnADevice, PairsOfTwoTrees) {
    for (const auto& [n, m] :
         {std::pair{300u, 17u}, {17u, 300u}, {0u, 5u}, {5u, 0u}, {600u, 600u}}) {
        const std::vector<Box> a = random_boxes(n, .2f, 1), b = random_boxes(m, .1f, 2);
        const DeviceBvh on_a(a, options()), on_b(b, options());
        const std::vector<Pair> wanted = brute_force(a, b), found = on_a.pairs(on_b);
        EXPECT_EQ(sorted(found), wanted);
        EXPECT_EQ(on_a.pair_count(on_b), wanted.size());
        EXPECT_EQ(on_a.pairs_on_device(on_b).to_host(), found);
    }
}

TEST_P(OnADevice, TreesOfDifferentKindsAreRefused) {
    const std::vector<Box> boxes = random_boxes(9, .2f, 1);
    const DeviceBvh a(boxes, {.builder = DeviceBuilder::hilbert, .place = {}}),
        b(boxes, {.builder = DeviceBuilder::lbvh, .place = {}});
    EXPECT_THAT([&] { a.pairs(b); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("same builder")));
}

TEST_P(OnADevice, BoxesThatLieThereStayThere) {
    const std::vector<Box> boxes = random_boxes(500, .2f, 3), moved = random_boxes(500, .2f, 4);
    DeviceArray<Box> own(std::span<const Box>(boxes), DevicePlace{});
    DeviceBvh bvh(own.span(), options());
    EXPECT_EQ(sorted(bvh.self_pairs()), boxwood::brute_force(boxes));
    own.write(moved); // the simulation goes on
    bvh.update(own.span());
    EXPECT_EQ(sorted(bvh.self_pairs()), boxwood::brute_force(moved));
    bvh.update(boxes); // and now from the host
    EXPECT_EQ(sorted(bvh.self_pairs()), boxwood::brute_force(boxes));
}

TEST_P(OnADevice, FollowsBoxesAndTheirNumber) {
    DeviceBvh bvh(random_boxes(300, .2f, 1), options());
    for (const std::uint32_t n : {300u, 300u, 20u, 0u, 700u}) {
        const std::vector<Box> boxes = random_boxes(n, .2f, n + 5);
        bvh.update(boxes);
        EXPECT_EQ(sorted(bvh.self_pairs()), boxwood::brute_force(boxes)) << n;
        bvh.rebuild(boxes);
        EXPECT_EQ(sorted(bvh.self_pairs()), boxwood::brute_force(boxes)) << n;
    }
    DeviceBvh other = std::move(bvh);
    EXPECT_EQ(other.size(), 700u);
}

TEST_P(OnADevice, ABadBoxIsNamedAndLeavesNothing) {
    std::vector<Box> boxes = random_boxes(300, .2f, 1);
    DeviceBvh bvh(boxes, options());
    boxes[7].max.y = std::numeric_limits<float>::quiet_NaN();
    boxes[200].min.x = 9;
    for (const bool again : {false, true}) {
        try {
            again ? bvh.rebuild(boxes) : bvh.update(boxes);
            FAIL() << "no InvalidBox";
        } catch (const InvalidBox& bad) {
            EXPECT_EQ(bad.index, 7u);
        }
        EXPECT_EQ(bvh.size(), 0u);
        EXPECT_EQ(bvh.self_pairs().size(), 0u);
        const std::vector<Box> good = random_boxes(300, .2f, 2);
        bvh.update(good);
        EXPECT_EQ(sorted(bvh.self_pairs()), boxwood::brute_force(good));
    }
}

TEST_P(OnADevice, OverflowIsCountedAndDoneAgain) {
    const std::vector<Box> few = random_boxes(600, .05f, 3), many = random_boxes(600, .3f, 3);
    DeviceBvh bvh(few, options());
    const auto at_once = [&] { return sorted(bvh.unordered_self_pairs().to_host()); };
    EXPECT_EQ(at_once(), boxwood::brute_force(few)); // the first time there is no room at all
    EXPECT_EQ(at_once(), boxwood::brute_force(few));
    bvh.update(many);
    const std::vector<Pair> wanted = boxwood::brute_force(many);
    EXPECT_EQ(at_once(), wanted);

    DeviceArray<Pair> room(100, DevicePlace{});
    EXPECT_EQ(bvh.self_pairs_into(room.span()), wanted.size());
    EXPECT_TRUE(std::ranges::includes(wanted, sorted(room.to_host())));
}

TEST_P(OnADevice, ARebuildMayBeEnqueuedAndCheckedLater) {
    const std::vector<Box> boxes = random_boxes(500, .2f, 3), moved = random_boxes(500, .2f, 4);
    DeviceArray<Box> own(std::span<const Box>(boxes), DevicePlace{});
    DeviceBvh bvh(own.span(), options());
    const std::vector<Pair> wanted = boxwood::brute_force(moved);
    DeviceArray<Pair> room(wanted.size(), DevicePlace{});
    DeviceArray<std::uint64_t> count(1, DevicePlace{});
    own.write(moved);
    bvh.enqueue_rebuild(own.span());
    bvh.enqueue_self_pairs(room.span(), count.span().data);
    bvh.check();
    EXPECT_EQ(count.to_host()[0], wanted.size());
    EXPECT_EQ(sorted(room.to_host()), wanted);

    std::vector<Box> bad = boxes;
    own.write(bad);
    bvh.enqueue_update(own.span());
    bvh.check();
    EXPECT_EQ(sorted(bvh.self_pairs()), boxwood::brute_force(boxes));
    bad[7].min.y = std::numeric_limits<float>::quiet_NaN();
    own.write(bad);
    for (const bool again : {false, true}) {
        again ? bvh.enqueue_rebuild(own.span()) : bvh.enqueue_update(own.span());
        bvh.enqueue_self_pairs(room.span(), count.span().data);
        EXPECT_THROW(bvh.check(), InvalidBox);
        EXPECT_EQ(bvh.size(), 0u);
        bvh.enqueue_self_pairs(room.span(), count.span().data);
        EXPECT_EQ(count.to_host()[0], 0u);
        EXPECT_THROW(bvh.enqueue_update(own.span()), std::invalid_argument);
        bvh.rebuild(boxes);
    }
}

TEST_P(OnADevice, AGraphRebuildsAndFindsPairsOfWhatIsThereThen) {
    const DeviceStream stream;
    std::vector<Box> boxes = random_boxes(300, .2f, 1);
    DeviceArray<Box> there(std::span<const Box>(boxes), stream.place());
    DeviceBvh bvh(std::as_const(there).span(), {.builder = GetParam(), .place = stream.place()});
    DeviceArray<Pair> room(5000, stream.place());
    DeviceArray<std::uint64_t> count(1, stream.place());
    DeviceGraph graph(stream.place(), [&] {
        bvh.enqueue_rebuild(std::as_const(there).span());
        bvh.enqueue_self_pairs(room.span(), count.span().data);
    });
    for (const unsigned seed : {1u, 2u, 3u}) {
        boxes = random_boxes(300, .1f * static_cast<float>(seed), seed);
        there.write(boxes);
        const std::uint64_t launches = launches_so_far();
        graph.launch();
        EXPECT_EQ(launches_so_far(), launches + 1);
        bvh.check();
        const std::vector<Pair> wanted = boxwood::brute_force(boxes);
        ASSERT_LE(wanted.size(), room.size());
        ASSERT_EQ(count.to_host(), std::vector<std::uint64_t>{wanted.size()});
        std::vector<Pair> found = room.to_host();
        found.resize(wanted.size());
        EXPECT_EQ(sorted(found), wanted);
    }
    EXPECT_THAT([] { DeviceGraph({}, [] {}); },
                ThrowsMessage<DeviceError>(HasSubstr("DeviceStream")));
}

/// Warps hand up what others wrote: a fence that is missing shows in few of many large trees, and
/// on a device alone.
TEST_P(OnADevice, StressOfManyBuildsAndRefits) {
    const bool is_real = devices().front().capability_major > 0;
    const std::size_t n = is_real ? 300'000 : 1500;
    DeviceBvh bvh(Boxes{}, options());
    for (unsigned round = 0; round < (is_real ? 30u : 2u); ++round) {
        const float size = 1.2f / std::cbrt(static_cast<float>(n));
        const std::vector<Box> boxes = random_boxes(n, size, round + 1);
        std::vector<Box> moved = boxes;
        for (std::size_t i = 0; i < n; ++i) // no further than a tree that is fitted again bears
            for (Vec3<float>* corner : {&moved[i].min, &moved[i].max})
                *corner =
                    *corner + Vec3<float>{size, -size, size} * (static_cast<float>(i % 7) / 3);
        for (const std::vector<Box>* now : {&boxes, &std::as_const(moved)}) {
            now == &boxes ? bvh.rebuild(*now) : bvh.update(*now);
            const PackedLayout packed(HilbertBuilder{}.build(*now, serial()), serial());
            std::vector<Pair> wanted;
            AppendPairs append(wanted);
            self_pairs(packed, serial(), append);
            ASSERT_GT(wanted.size(), n / 10);
            ASSERT_EQ(in_any_order(bvh.self_pairs()), in_any_order(wanted)) << "round " << round;
            ASSERT_EQ(in_any_order(bvh.unordered_self_pairs().to_host()), in_any_order(wanted))
                << "round " << round;
        }
    }
}

TEST_P(OnADevice, ASinkMayStop) {
    const DeviceBvh bvh(random_boxes(600, .3f, 3), options());
    std::size_t seen = 0;
    ForEachPair first([&](Pair) { return ++seen < 10; });
    bvh.self_pairs(first);
    EXPECT_EQ(seen, 10u);
}

TEST_P(OnADevice, AnotherDeviceIsNotThere) {
    EXPECT_THAT([&] { DeviceBvh(Boxes{}, {.builder = GetParam(), .place = {.index = 99}}); },
                ThrowsMessage<DeviceError>(HasSubstr("there is no CUDA device 99")));
}

TEST(Devices, ThereAreSomeOrAReason) {
    EXPECT_EQ(devices().empty(), !why_no_device().empty());
    if (devices().empty()) {
        EXPECT_THAT([] { DeviceBvh(Boxes{}); },
                    ThrowsMessage<DeviceError>("no CUDA device: " + why_no_device()));
    }
}

TEST(Devices, OutOfMemorySaysHowMuch) {
    const DeviceOutOfMemory error("a tree", 21'300'000'000, 1'500'000);
    EXPECT_STREQ(error.what(),
                 "a tree needs 21.3 GB of the device's memory, and 0.0015 GB are free");
    EXPECT_EQ(error.needed, 21'300'000'000u);
}

} // namespace
} // namespace boxwood
