#include "trees/dynamic/detail/survey.h"

#include "trees/testing/box_families.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace boxwood {
using namespace detail;
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity(),
                nan = std::numeric_limits<float>::quiet_NaN();

Survey one_by_one(Boxes boxes) {
    Survey survey;
    for (const Box& box : boxes)
        if (is_absent(box))
            survey.some_absent = true;
        else
            survey.centres.extend(.5f * box.min + .5f * box.max);
    return survey;
}

void expect_found(Boxes boxes, const std::string& name) {
    const Survey expected = one_by_one(boxes);
    for (const unsigned threads : {1u, 3u}) {
        const Survey found = survey_of(boxes, *make_executor("openmp", threads));
        EXPECT_EQ(found.centres, expected.centres) << name;
        EXPECT_EQ(found.some_absent, expected.some_absent) << name;
    }
}

TEST(Survey, CentresAndAbsentItemsAreFound) {
    expect_found({}, "none");
    for (const BoxFamily& family : box_families()) {
        expect_found(family.boxes, family.name);
        for (const std::size_t each : {1u, 2u, 3u, 7u, 1000u}) {
            auto boxes = family.boxes;
            for (std::size_t i = 0; i < boxes.size(); i += each)
                boxes[i] = Box{};
            expect_found(boxes, family.name + ", one in " + std::to_string(each) + " absent");
        }
    }
}

TEST(Survey, EveryBadCoordinateIsFoundWhereverItIs) {
    for (const bool with_absent : {false, true})
        for (const std::size_t n : {1u, 5u, 9u, 40u, 1030u}) {
            auto good = random_boxes(n, .2f, 3);
            if (with_absent)
                good[n / 2] = Box{};
            for (std::size_t i = 0; i<n; i += n> 40 ? 41 : 1) {
                auto boxes = good;
                const auto expect_thrown = [&](const auto& what) {
                    EXPECT_THAT([&] { survey_of(boxes, serial()); },
                                testing::Throws<InvalidBox>(testing::Field(&InvalidBox::index, i)))
                        << what;
                };
                for (int place = 0; place < 6; ++place)
                    for (const float bad : {nan, infinite, -infinite}) {
                        boxes[i] = {{0, 0, 0}, {1, 1, 1}};
                        (place < 3 ? boxes[i].min : boxes[i].max)[place % 3] = bad;
                        expect_thrown(place);
                    }
                for (int axis = 0; axis < 3; ++axis) {
                    boxes[i] = {{0, 0, 0}, {1, 1, 1}};
                    boxes[i].min[axis] = 0x1p-149f; // the least there is
                    boxes[i].max[axis] = 0;
                    expect_thrown("min > max");
                    boxes[i] = {{0, 0, 0}, {1, 1, 1}};
                    boxes[i].min[axis] = infinite; // absent along one axis alone
                    boxes[i].max[axis] = -infinite;
                    expect_thrown("absent in part");
                }
            }
        }
}

} // namespace
} // namespace boxwood
