#include "trees/builders/hilbert.h"
#include "trees/cuda/builds/codes.cuh"
#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace boxwood::cuda {
namespace {

BoxFamily bars(std::size_t n) {
    BoxFamily family{"bars", random_boxes(n, .01f, 6)};
    for (std::size_t i = 0; i < n; ++i)
        family.boxes[i].max[static_cast<int>(i % 3)] += 2;
    return family;
}

Centres measured(Boxes boxes, std::size_t max_blocks = max_measure_blocks) {
    Centres centres = no_centres();
    const auto n = static_cast<std::uint32_t>(boxes.size());
    launch(Stream{}, std::min(blocks_for(n, code_threads), max_blocks), code_threads,
           measure_centres, boxes.data(), n, &centres);
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
            EXPECT_EQ(measured(boxes, 1 + seed).first_bad, 413u);
        }
}

CodeRule rule_of(const BoxFamily& family, bool may_part) {
    const Centres centres = measured(family.boxes);
    CodeRule rule;
    launch(Stream{}, 1, code_threads, make_code_rule<10>, family.boxes.data(),
           static_cast<std::uint32_t>(family.boxes.size()), &centres, may_part, &rule);
    return rule;
}

template <int bits, class Code>
std::vector<Code> codes_of(const BoxFamily& family, Curve curve, bool apart) {
    const auto n = static_cast<std::uint32_t>(family.boxes.size());
    const CodeRule rule{curve_grid(boxwood::measure_centres(family.boxes).box, bits), apart};
    std::vector<Code> codes(n);
    std::vector<std::uint32_t> items(n);
    launch(Stream{}, blocks_for(n, code_threads), code_threads, curve_codes<bits, Code>,
           family.boxes.data(), n, curve, &rule, codes.data(), items.data());
    for (std::uint32_t i = 0; i < n; ++i)
        EXPECT_EQ(items[i], i);
    return codes;
}

template <int bits, class Code> void expect_codes(const BoxFamily& family, Curve curve) {
    const CurveGrid grid = curve_grid(boxwood::measure_centres(family.boxes).box, bits);
    std::vector<Code> wanted(family.boxes.size());
    if constexpr (bits == 10)
        coarse_codes(family.boxes, curve, grid, wanted.data());
    else
        fine_codes(family.boxes, curve, grid, wanted.data());
    EXPECT_EQ((codes_of<bits, Code>(family, curve, false)), wanted);
    const GroupOfBox group = HilbertBuilder::groups(bars(1).boxes);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const Code above = group(family.boxes[i]);
        wanted[i] = bits == 10 ? wanted[i] | above << 30 : wanted[i] >> 1 | above << 62;
    }
    EXPECT_EQ((codes_of<bits, Code>(family, curve, true)), wanted);
}

TEST(CodesOnDevice, TheRuleIsThatOfTheHilbertBuilder) {
    std::vector<BoxFamily> families = box_families();
    families.push_back(bars(700));
    families.push_back(bars(2500));
    for (const BoxFamily& family : families) {
        SCOPED_TRACE(family.name);
        if (family.boxes.empty())
            continue;
        const CurveGrid grid = curve_grid(boxwood::measure_centres(family.boxes).box, 10);
        for (std::uint64_t seed = 0; seed < 2; ++seed) {
            on_host::set_seed(seed);
            const CodeRule rule = rule_of(family, true);
            EXPECT_EQ(rule.grid.low, grid.low);
            EXPECT_EQ(rule.grid.power, grid.power);
            EXPECT_EQ(rule.grid.scale, grid.scale);
            EXPECT_EQ(rule.apart, HilbertBuilder::groups(family.boxes) != nullptr);
        }
        EXPECT_FALSE(rule_of(family, false).apart);
    }
}

TEST(CodesOnDevice, CountsThoseInCrowds) {
    std::vector<std::uint32_t> codes(1000);
    for (std::uint32_t i = 0; i < 1000; ++i)
        codes[i] = i < 40 ? 5 : i < 49 ? 6 : i < 57 ? 7 : i; // 40, 9 and 8 of the same
    std::uint32_t crowded = 0;
    launch(Stream{}, blocks_for(1000, code_threads), code_threads, count_crowded<std::uint32_t>,
           codes.data(), 1000u, &crowded);
    EXPECT_EQ(crowded, 32u + 1);
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
