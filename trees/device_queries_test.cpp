/// Compiled twice, as device_test.cpp.

#include "trees/builder.h"
#include "trees/device.h"
#include "trees/layout.h"
#include "trees/testing/box_families.h"
#include "trees/testing/region_queries.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace boxwood {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<Pair> pairs_of(const AnswersOf<std::uint32_t>& found) {
    std::vector<Pair> pairs;
    for (std::uint32_t query = 0; query + 1 < found.offsets.size(); ++query)
        for (const std::uint32_t item : found[query])
            pairs.push_back({query, item});
    return pairs;
}

std::unique_ptr<AnyLayout> on_cpu(Boxes boxes) {
    return find_layout("binary").make(make_builder("median")(boxes, serial()), serial());
}

/// Of at most so many boxes.
std::vector<BoxFamily> families(std::size_t max) {
    std::vector<BoxFamily> all = box_families();
    for (const std::size_t n : {15u, 16u, 255u, 256u, 257u, 4097u})
        all.push_back({"random " + std::to_string(n), random_boxes(n, n > 1000 ? .05f : .2f, 5)});
    std::erase_if(all, [max](const BoxFamily& family) { return family.boxes.size() > max; });
    return all;
}

/// All of them for few boxes; of many, where a model of a device is slow, the odd ones at the end
/// and some of those before.
template <class Query> std::vector<Query> some(const std::vector<Query>& all, std::size_t n_boxes) {
    if (n_boxes <= 17)
        return all;
    std::vector<Query> few;
    for (std::size_t i = 0; i<all.size(); i += i + 7> all.size() ? 1 : 8)
        few.push_back(all[i]);
    return few;
}

class QueriesOnADevice : public ::testing::TestWithParam<DeviceBuilder> {
  protected:
    void SetUp() override {
        if (devices().empty())
            GTEST_SKIP() << why_no_device();
    }
    DeviceBvh made(Boxes boxes) const { return DeviceBvh(boxes, {GetParam(), {}}); }
};
INSTANTIATE_TEST_SUITE_P(Device, QueriesOnADevice,
                         ::testing::Values(DeviceBuilder::hilbert, DeviceBuilder::lbvh,
                                           DeviceBuilder::hploc));

TEST_P(QueriesOnADevice, FindTheItemsThatTheCpuFinds) {
    // Others have few boxes: the model of a device is slow.
    for (const BoxFamily& family : families(GetParam() == DeviceBuilder::lbvh ? 6000 : 512)) {
        SCOPED_TRACE(family.name);
        const auto layout = on_cpu(family.boxes);
        const QueriesOfRegions all = queries_for(family.boxes);
        const auto points = some(all.points, family.boxes.size());
        const auto boxes = some(all.boxes, family.boxes.size());
        const auto balls = some(all.balls, family.boxes.size());
        std::vector<Pair> in_points, in_boxes, in_balls;
        AppendPairs to_points(in_points), to_boxes(in_boxes), to_balls(in_balls);
        layout->regions(balls, serial(), to_balls);
        layout->points(points, serial(), to_points);
        layout->regions(boxes, serial(), to_boxes);
        const DeviceBvh bvh = made(family.boxes);
        EXPECT_EQ(pairs_of(bvh.containing(points)), in_points);
        EXPECT_EQ(pairs_of(bvh.overlapping(boxes)), in_boxes);
        EXPECT_EQ(pairs_of(bvh.overlapping(balls)), in_balls);
        if (family.boxes.size() == 17) {
            const DeviceArray<Box> there(std::span<const Box>(boxes), DevicePlace{});
            EXPECT_EQ(pairs_of(bvh.overlapping(there.span()).to_host()), in_boxes);
        }
    }
}

/// So many that a warp has each.
TEST_P(QueriesOnADevice, MayBeMany) {
    const std::vector<Box> boxes = random_boxes(700, .1f, 3), many = random_boxes(1100, .02f, 4);
    std::vector<Pair> wanted;
    AppendPairs append(wanted);
    on_cpu(boxes)->regions(many, serial(), append);
    EXPECT_EQ(pairs_of(made(boxes).overlapping(many)), wanted);
}

TEST_P(QueriesOnADevice, MayBeNone) {
    for (const std::size_t n : {0u, 100u}) {
        const DeviceBvh bvh = made(random_boxes(n, .1f, 3));
        EXPECT_EQ(bvh.overlapping(Boxes{}).offsets, std::vector<std::uint64_t>{0});
        EXPECT_EQ(bvh.containing(std::vector<Vec3<float>>{}).of.size(), 0u);
    }
}

TEST_P(QueriesOnADevice, NearestIsThatOfTheCpuOrRefused) {
    const std::vector<Vec3<float>> one(1);
    if (GetParam() == DeviceBuilder::hilbert) {
        EXPECT_THAT([&] { made(random_boxes(9, .1f, 3)).nearest(one, 2); },
                    ThrowsMessage<std::invalid_argument>(HasSubstr("lbvh")));
        return;
    }
    for (const BoxFamily& family : families(GetParam() == DeviceBuilder::lbvh ? 6000 : 50)) {
        SCOPED_TRACE(family.name);
        const auto layout = on_cpu(family.boxes);
        const std::vector<Vec3<float>> points = queries_for(family.boxes).points;
        const DeviceBvh bvh = made(family.boxes);
        for (const std::size_t k : {0u, 1u, 8u}) {
            std::vector<Neighbour> wanted(k * points.size());
            layout->nearest(points, k, serial(), wanted);
            EXPECT_EQ(bvh.nearest(points, k), wanted) << k;
        }
        EXPECT_EQ(bvh.nearest(std::span<const Vec3<float>>{}, 3).size(), 0u);
    }
    EXPECT_THROW(made({}).nearest(one, std::size_t{1} << 40), std::length_error);
}

} // namespace
} // namespace boxwood
