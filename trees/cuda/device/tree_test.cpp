// What only the host's model of a device shows: memory that is short, at every size of it.

#include "trees/cuda/device/machine.h"
#include "trees/cuda/device/machine_on_host.h"
#include "trees/cuda/device/pair_parts.cuh"
#include "trees/device.h"
#include "trees/testing/box_families.h"
#include "trees/testing/brute_force.h"
#include "trees/testing/ray_scenes.h"
#include "trees/testing/triangle_soup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace boxwood::cuda {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

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

constexpr DeviceBuilder builders[] = {DeviceBuilder::hilbert, DeviceBuilder::lbvh,
                                      DeviceBuilder::hploc};

class MemoryOfEach : public ::testing::TestWithParam<DeviceBuilder> {};
INSTANTIATE_TEST_SUITE_P(Device, MemoryOfEach, ::testing::ValuesIn(builders));

TEST_P(MemoryOfEach, ShortOfItPairsComeInParts) {
    const std::vector<Box> boxes = random_boxes(400, .9f, 3), others = random_boxes(300, .9f, 4);
    const DeviceBvhOptions options{.builder = GetParam(), .place = {}};
    const DeviceBvh bvh(boxes, options), other(others, options);
    Parts whole, whole_of_two;
    bvh.self_pairs(whole);
    bvh.pairs(other, whole_of_two);
    EXPECT_EQ(whole.chunks, 1u);
    ASSERT_EQ(sorted(whole.pairs), brute_force(boxes));
    for (const std::uint64_t share : {2, 5, 9}) {
        const FreeMemory free((1 << 16) + 9 * 1024 + whole.pairs.size() * sizeof(Pair) / share);
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

/// Tries all sizes of the memory. A Fault of the model would say that something was allocated for
/// which nobody had looked.
template <class Try> void expect_known_before(std::uint64_t up_to, const Try& attempt) {
    std::size_t refused = 0, answered = 0;
    for (std::uint64_t bytes = 0; bytes < up_to; bytes += up_to / 15) {
        const FreeMemory free(bytes);
        try {
            attempt();
            ++answered;
        } catch (const DeviceOutOfMemory& error) {
            EXPECT_GT(error.needed, error.free);
            EXPECT_LE(error.free, bytes);
            EXPECT_THAT(error.what(), HasSubstr("of the device's memory"));
            ++refused;
        }
    }
    EXPECT_GT(refused, 1u);
    EXPECT_GT(answered, 1u);
}

TEST_P(MemoryOfEach, IsKnownBeforeAnythingStarts) {
    const std::vector<Box> boxes = random_boxes(100, .3f, 3), regions = random_boxes(20, .3f, 4);
    const std::vector<Pair> wanted = brute_force(boxes);
    const DeviceBvhOptions options{.builder = GetParam(), .place = {}};
    expect_known_before(150'000, [&] {
        const DeviceBvh bvh(boxes, options);
        ASSERT_EQ(sorted(bvh.self_pairs()), wanted);
        ASSERT_EQ(bvh.self_pairs_on_device().size(), wanted.size());
    });

    DeviceBvh bvh(boxes, options);
    const std::vector<std::uint32_t> in_regions = bvh.overlapping(regions).of;
    expect_known_before(150'000, [&] { ASSERT_EQ(bvh.overlapping(regions).of, in_regions); });
    EXPECT_EQ(bvh.size(), 100u);

    std::size_t emptied = 0; // by what there was no memory for
    const std::vector<Box> more = random_boxes(400, .1f, 5);
    for (std::uint64_t bytes = 0; bytes < 80'000; bytes += 20'000) {
        bvh.rebuild(boxes);
        try {
            const FreeMemory free(bytes);
            bvh.update(more);
        } catch (const DeviceOutOfMemory&) {
            EXPECT_EQ(bvh.size(), 0u);
            EXPECT_EQ(bvh.self_pair_count(), 0u);
            ++emptied;
        }
    }
    EXPECT_GT(emptied, 1u);
    bvh.update(boxes);
    EXPECT_EQ(sorted(bvh.self_pairs()), wanted);
}

TEST_P(MemoryOfEach, OfAMeshIsKnownToo) {
    const TriangleMesh mesh = triangle_soup(60);
    const std::vector<Ray<float>> all = test_rays(), rays(all.begin(), all.begin() + 20);
    const DeviceMeshBvhOptions options{.builder = GetParam(), .sort_rays = true};
    DeviceMeshBvh bvh(mesh, options);
    const std::vector<RayHit> wanted = bvh.closest_hits(rays);
    expect_known_before(150'000, [&] {
        const DeviceMeshBvh made(mesh, options);
        ASSERT_EQ(made.closest_hits(rays), wanted);
    });
    expect_known_before(140'000, [&] {
        if (GetParam() != DeviceBuilder::hilbert)
            bvh.all_hits(rays);
        ASSERT_EQ(bvh.closest_hits(rays), wanted);
    });
    expect_known_before(4'000, [&] { bvh.update(mesh.vertices); });
    EXPECT_EQ(bvh.closest_hits(rays), wanted); // an update without memory changes nothing
}

TEST_P(MemoryOfEach, NoneIsAllocatedWhereAGraphMayCapture) {
    const std::vector<Box> boxes = random_boxes(300, .2f, 3);
    const DeviceArray<Box> there(std::span<const Box>(boxes), DevicePlace{});
    DeviceArray<Pair> room(100, DevicePlace{});
    DeviceArray<std::uint64_t> count(1, DevicePlace{});
    DeviceBvh bvh(there.span(), {.builder = GetParam(), .place = {}});
    const std::vector<std::function<void()>> work = on_host::record([&] {
        for (int frame = 0; frame < 3; ++frame) {
            bvh.enqueue_rebuild(there.span());
            bvh.enqueue_self_pairs(room.span(), count.span().data);
            bvh.enqueue_update(there.span());
        }
    });
    for (const std::function<void()>& one : work)
        one();
    EXPECT_TRUE(bvh.check());
    EXPECT_EQ(count.to_host()[0], brute_force(boxes).size());
    const FreeMemory none(0);
    bvh.rebuild(there.span());
}

TEST_P(MemoryOfEach, AGraphThatAllocatesIsRefused) {
    const DeviceStream stream;
    const std::vector<Box> boxes = random_boxes(30, .2f, 3);
    const DeviceArray<Box> there(std::span<const Box>(boxes), stream.place());
    DeviceBvh bvh(there.span(), {.builder = GetParam(), .place = stream.place()});
    EXPECT_THAT([&] { DeviceGraph(stream.place(), [&] { bvh.unordered_self_pairs(); }); },
                ThrowsMessage<DeviceError>(HasSubstr("cannot record what allocates")));
    EXPECT_EQ(sorted(bvh.self_pairs()), brute_force(boxes)); // nothing was left in recording
    EXPECT_THAT([&] { DeviceGraph(stream.place(), [&] { bvh.check(); }); },
                ThrowsMessage<DeviceError>(HasSubstr("cannot record what copies to the host")));
    EXPECT_EQ(bvh.size(), 0u);
}

/// Four fifths of them crowd in the middle of a room that a few span: finer codes are needed.
std::vector<Box> crowded_boxes() {
    std::vector<Box> boxes = random_boxes(600, .2f, 3);
    for (std::size_t i = 0; i < boxes.size(); ++i)
        if (i % 5 != 0)
            for (int axis = 0; axis < 3; ++axis) {
                boxes[i].min[axis] *= 1e-6f;
                boxes[i].max[axis] *= 1e-6f;
            }
    return boxes;
}

TEST_P(MemoryOfEach, AGraphOutlivesARebuildByFinerCodes) {
    const DeviceStream stream;
    std::vector<Box> boxes = random_boxes(600, .2f, 3);
    DeviceArray<Box> there(std::span<const Box>(boxes), stream.place());
    DeviceArray<Pair> room(200'000, stream.place());
    DeviceArray<std::uint64_t> count(1, stream.place());
    DeviceBvh bvh(std::as_const(there).span(), {.builder = GetParam(), .place = stream.place()});
    DeviceGraph graph(stream.place(), [&] {
        bvh.enqueue_rebuild(std::as_const(there).span());
        bvh.enqueue_self_pairs(room.span(), count.span().data);
    });
    boxes = crowded_boxes();
    there.write(boxes);
    graph.launch();
    EXPECT_EQ(bvh.check(), GetParam() != DeviceBuilder::hilbert); // its codes are coarse at first
    bvh.rebuild(std::as_const(there).span());
    graph.launch();
    EXPECT_EQ(count.to_host()[0], brute_force(boxes).size());
    graph.launch();
    bvh.enqueue_rebuild(std::as_const(there).span());
    EXPECT_TRUE(bvh.check());
}

TEST_P(MemoryOfEach, AnUpdateFromTheHostFitsTheBoxesThatWereTheCallers) {
    const std::vector<Box> boxes = random_boxes(400, .2f, 3), moved = random_boxes(400, .2f, 4);
    const DeviceArray<Box> there(std::span<const Box>(boxes), DevicePlace{});
    DeviceBvh bvh(there.span(), {.builder = GetParam(), .place = {}}),
        again(there.span(), {.builder = GetParam(), .place = {}});
    std::uint64_t before = launches_so_far();
    again.rebuild(moved);
    const std::uint64_t of_a_rebuild = launches_so_far() - before;
    before = launches_so_far();
    bvh.update(moved);
    EXPECT_LT(launches_so_far() - before, of_a_rebuild);
    EXPECT_EQ(sorted(bvh.self_pairs()), brute_force(moved));
    const DeviceArray<Box> back(std::span<const Box>(boxes), DevicePlace{});
    bvh.update(back.span());
    const FreeMemory none(0);
    EXPECT_THROW(bvh.update(moved), DeviceOutOfMemory);
    EXPECT_EQ(bvh.size(), 0u);
}

TEST_P(MemoryOfEach, UnorderedPairsTakeWhatRoomThereIs) {
    const std::vector<Box> many = random_boxes(400, .9f, 3), few = random_boxes(400, .1f, 3);
    const DeviceArray<Box> first(std::span<const Box>(many), DevicePlace{}),
        then(std::span<const Box>(few), DevicePlace{});
    DeviceBvh bvh(first.span(), {.builder = GetParam(), .place = {}});
    ASSERT_GT(bvh.unordered_self_pairs().size(), 10'000u);
    bvh.update(then.span());
    const FreeMemory free(40'000);
    EXPECT_EQ(sorted(bvh.unordered_self_pairs().to_host()), brute_force(few));
}

TEST(MemoryOfADevice, AnArrayIsWrittenWhole) {
    DeviceArray<int> array(3, DevicePlace{});
    const std::vector<int> two(2), three{1, 2, 3};
    EXPECT_THROW(array.write(two), std::invalid_argument);
    array.write(three);
    EXPECT_EQ(array.to_host(), three);
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
