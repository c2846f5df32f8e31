// What only the host's model of a device shows: memory that is short, at every size of it.

#include "trees/cuda/device/machine.h"
#include "trees/cuda/device/machine_on_host.h"
#include "trees/cuda/device/pair_parts.cuh"
#include "trees/testing/box_families.h"
#include "trees/testing/brute_force.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood::cuda {
namespace {

using ::testing::HasSubstr;

std::vector<Pair> sorted(std::vector<Pair> pairs) {
    std::ranges::sort(pairs);
    return pairs;
}

/// A sink that knows in how many parts the pairs came.
struct Parts final : PairSink {
    std::size_t chunks = 0;
    std::vector<Pair> pairs;
    void begin(std::size_t n, bool) override { chunks = n; }
    bool take(std::size_t, std::span<const Pair> more) override {
        pairs.insert(pairs.end(), more.begin(), more.end());
        return true;
    }
    void end() override {}
};

TEST(MemoryOfADevice, ShortOfItPairsComeInParts) {
    const std::vector<Box> boxes = random_boxes(1500, .4f, 3), others = random_boxes(400, .2f, 4);
    const DeviceBvh bvh(boxes), other(others);
    Parts whole, whole_of_two;
    bvh.self_pairs(whole);
    bvh.pairs(other, whole_of_two);
    EXPECT_EQ(whole.chunks, 1u);
    ASSERT_EQ(sorted(whole.pairs), brute_force(boxes));
    for (const std::uint64_t share : {2, 5, 9}) {
        const FreeMemory free((1 << 16) + 4096 + whole.pairs.size() * sizeof(Pair) / share);
        Parts parts, parts_of_two;
        bvh.self_pairs(parts);
        bvh.pairs(other, parts_of_two);
        EXPECT_GT(parts.chunks, 1u);
        EXPECT_EQ(parts.pairs, whole.pairs) << "not the same in this order, by " << share;
        EXPECT_EQ(parts_of_two.pairs, whole_of_two.pairs);
        EXPECT_THROW(bvh.self_pairs_on_device(), DeviceOutOfMemory);
        EXPECT_EQ(bvh.self_pair_count(), whole.pairs.size());
    }
}

/// A Fault of the model would say that something was allocated for which nobody had looked.
TEST(MemoryOfADevice, IsKnownBeforeAnythingStarts) {
    const std::vector<Box> boxes = random_boxes(300, .3f, 3);
    const std::vector<Pair> wanted = brute_force(boxes);
    for (const DeviceBuilder builder : {DeviceBuilder::hilbert, DeviceBuilder::lbvh}) {
        std::size_t refused = 0, answered = 0;
        for (std::uint64_t bytes = 0; bytes < 250'000; bytes += 7'919) {
            const FreeMemory free(bytes);
            try {
                const DeviceBvh bvh(boxes, {.builder = builder, .place = {}});
                ASSERT_EQ(sorted(bvh.self_pairs()), wanted);
                ASSERT_EQ(bvh.self_pairs_on_device().size(), wanted.size());
                ++answered;
            } catch (const DeviceOutOfMemory& error) {
                EXPECT_GT(error.needed, error.free);
                EXPECT_LE(error.free, bytes);
                EXPECT_THAT(error.what(), HasSubstr("of the device's memory"));
                ++refused;
            }
        }
        EXPECT_GT(refused, 10u);
        EXPECT_GT(answered, 10u);
    }
}

TEST(MemoryOfADevice, GoesBack) {
    const std::uint64_t before = on_host::free_memory();
    {
        DeviceBvh bvh(random_boxes(700, .3f, 3));
        bvh.self_pairs();
        bvh.unordered_self_pairs();
        EXPECT_LT(on_host::free_memory(), before);
    }
    EXPECT_EQ(on_host::free_memory(), before);
}

TEST(PartsOfPairs, AreOfWholeLeavesAndFit) {
    const std::vector<std::uint64_t> at{0, 3, 3, 10, 11, 30, 30};
    const auto cut = [&](std::uint64_t room) {
        std::vector<std::uint64_t> ends;
        std::uint32_t leaf = 0;
        for (const PairPart& part : cut_into_parts(at, room)) {
            EXPECT_EQ(part.first_leaf, leaf);
            EXPECT_EQ(part.first_pair, at[leaf]);
            EXPECT_EQ(part.end_pair, at[part.end_leaf]);
            leaf = part.end_leaf;
            ends.push_back(leaf);
        }
        EXPECT_EQ(leaf, 6u);
        return ends;
    };
    EXPECT_EQ(cut(100), (std::vector<std::uint64_t>{6}));
    EXPECT_EQ(cut(11), (std::vector<std::uint64_t>{4, 5, 6})); // leaf 4 has more
    EXPECT_EQ(cut(8), (std::vector<std::uint64_t>{2, 4, 5, 6}));
    EXPECT_EQ(cut(0), (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6}));
}

TEST(Machine, SaysWhyThereIsNoDevice) {
    EXPECT_THAT(why_none(0, 13000, 0), HasSubstr("no driver: install NVIDIA's for CUDA 13.0"));
    EXPECT_THAT(why_none(12040, 13000, 0), HasSubstr("CUDA 12.4, older than the runtime 13.0"));
    EXPECT_THAT(why_none(13020, 13000, 0), HasSubstr("CUDA_VISIBLE_DEVICES"));
    EXPECT_EQ(why_none(13020, 13000, 1), "");
}

TEST(Machine, KnowsWhatItsCodeRunsOn) {
    const std::string_view ours = "80-real,90-real,90-virtual";
    for (const auto& [major, minor, runs] :
         {std::tuple{7, 5, false}, {8, 0, true}, {8, 6, true}, {9, 0, true}, {12, 0, true}})
        EXPECT_EQ(runs_on(ours, major, minor), runs) << major << "." << minor;
    EXPECT_FALSE(runs_on("80-real", 9, 0));
    EXPECT_FALSE(runs_on("86-real", 8, 0));
    EXPECT_TRUE(runs_on("80", 9, 0));
    EXPECT_TRUE(runs_on("native", 1, 0));
    EXPECT_FALSE(runs_on("", 9, 0));
}

} // namespace
} // namespace boxwood::cuda
