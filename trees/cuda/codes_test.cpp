#include "trees/cuda/codes.cuh"
#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace boxwood::cuda {
namespace {

Centres measured(Boxes boxes) {
    Centres centres = no_centres();
    const auto n = static_cast<std::uint32_t>(boxes.size());
    launch(Stream{}, blocks_for(n, code_threads), code_threads, measure_centres, boxes.data(), n,
           &centres);
    return centres;
}

TEST(CodesOnDevice, CentresAreThoseOfTheCpu) {
    for (const BoxFamily& family : box_families()) {
        SCOPED_TRACE(family.name);
        const CentreBounds wanted = boxwood::measure_centres(family.boxes);
        const Centres found = measured(family.boxes);
        EXPECT_EQ(found.first_bad, none_bad);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(from_ordered(found.low[axis]), wanted.box.min[axis]);
            EXPECT_EQ(from_ordered(found.high[axis]), wanted.box.max[axis]);
        }
    }
}

TEST(CodesOnDevice, TheFirstBadBoxIsFound) {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
    for (const Box& bad : {Box{{nan, 0, 0}, {1, 1, 1}}, Box{{0, 0, 0}, {1, inf, 1}},
                           Box{{0, 0, 2}, {1, 1, 1}}, Box{{0, -inf, 0}, {1, 1, 1}}})
        for (std::uint64_t seed = 0; seed < 8; ++seed) {
            on_host::set_seed(seed);
            std::vector<Box> boxes = random_boxes(1000, .1f, 1);
            boxes[700] = boxes[413] = bad;
            EXPECT_EQ(measured(boxes).first_bad, 413u);
        }
}

template <int bits, class Code> void expect_codes(const BoxFamily& family, Curve curve) {
    const auto n = static_cast<std::uint32_t>(family.boxes.size());
    const CurveGrid grid = curve_grid(boxwood::measure_centres(family.boxes).box, bits);
    std::vector<Code> wanted(n), found(n);
    std::vector<std::uint32_t> items(n);
    if constexpr (bits == 10)
        coarse_codes(family.boxes, curve, grid, wanted.data());
    else
        fine_codes(family.boxes, curve, grid, wanted.data());
    launch(Stream{}, blocks_for(n, code_threads), code_threads, curve_codes<bits, Code>,
           family.boxes.data(), n, curve, grid, found.data(), items.data());
    EXPECT_EQ(found, wanted);
    for (std::uint32_t i = 0; i < n; ++i)
        EXPECT_EQ(items[i], i);
}

TEST(CodesOnDevice, HaveTheBitsOfTheCpu) {
    for (const BoxFamily& family : box_families())
        for (const Curve curve : {Curve::morton, Curve::hilbert}) {
            SCOPED_TRACE(family.name + (curve == Curve::morton ? ", Morton" : ", Hilbert"));
            expect_codes<10, std::uint32_t>(family, curve);
            expect_codes<21, std::uint64_t>(family, curve);
        }
}

} // namespace
} // namespace boxwood::cuda
