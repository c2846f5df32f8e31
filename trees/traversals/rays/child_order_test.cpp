// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/rays/child_order_test.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "kernels/testing/every_target.h"
#include "trees/traversals/rays/node_clip-inl.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#ifndef BOXWOOD_CHILD_ORDER_TEST_CPP
#define BOXWOOD_CHILD_ORDER_TEST_CPP
namespace boxwood::detail {
/// WaitingNode, the same for all instruction sets.
struct Waits {
    std::uint32_t ref;
    float entry;
};
} // namespace boxwood::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// What is on the stack, the lowest first, and in nearest the reference of the least of `bits`.
std::vector<Waits> stack_of_eight([[maybe_unused]] const std::array<float, 8>& entries,
                                  [[maybe_unused]] const std::array<std::uint32_t, 8>& refs,
                                  [[maybe_unused]] std::uint32_t bits,
                                  [[maybe_unused]] std::uint32_t& nearest) {
    std::vector<Waits> waiting;
#if BOXWOOD_SORTS_EIGHT
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<std::uint32_t, 8> du;
    const hn::CappedTag<float, 8> df;
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits)};
    const auto hit = hn::LoadMaskBits(du, bytes);
    const auto keys = keys_of(hn::LoadU(df, entries.data()));
    std::array<WaitingNode, 8> stack;
    push_sorted_eight(refs.data(), hn::IfThenElseZero(hit, keys), stack.data());
    for (int i = 0; i < std::popcount(bits); ++i)
        waiting.push_back({stack[i].ref, stack[i].entry});
    if (bits != 0)
        nearest = refs[hn::GetLane(min_key(keys, hit)) & 7];
#endif
    return waiting;
}

bool sorts_eight() { return BOXWOOD_SORTS_EIGHT; }

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#ifdef __AVX2__
static_assert(HWY_STATIC_TARGET <= HWY_AVX2,
              "of AVX2, but not as Highway has it: -maes is missing");
#endif

namespace boxwood::detail {
HWY_EXPORT(stack_of_eight);
HWY_EXPORT(sorts_eight);
namespace {

/// Rounded down to a multiple of eight ulp, as entries on the stack are.
float rounded(float entry) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(std::abs(entry)) & ~7u);
}

void expect_the_nearest_last(const std::array<float, 8>& entries, std::uint32_t bits) {
    const std::array<std::uint32_t, 8> refs = {70, 61, 52, 43, 34, 25, 16, 7};
    std::uint32_t nearest = 0;
    const auto stack = HWY_DYNAMIC_DISPATCH(stack_of_eight)(entries, refs, bits, nearest);
    std::vector<std::pair<float, std::uint32_t>> expected; // of equal entries the last lane first
    for (std::uint32_t lane = 0; lane < 8; ++lane)
        if (bits >> lane & 1)
            expected.emplace_back(rounded(entries[lane]), refs[lane]);
    std::ranges::stable_sort(expected, {}, &std::pair<float, std::uint32_t>::first);
    std::ranges::reverse(expected);
    ASSERT_EQ(stack.size(), expected.size());
    for (std::size_t i = 0; i < stack.size(); ++i) {
        EXPECT_EQ(stack[i].entry, expected[i].first) << i;
        EXPECT_EQ(stack[i].ref, expected[i].second) << i;
    }
    if (bits != 0) {
        EXPECT_EQ(nearest, expected.back().second);
    }
}

/// With each instruction set whose registers hold eight; skips where there is none.
template <class Test> void where_eight_are_sorted(const Test& test) {
    int found = 0;
    on_every_target([&] {
        if (!HWY_DYNAMIC_DISPATCH(sorts_eight)())
            return;
        ++found;
        test();
    });
    if (found == 0)
        GTEST_SKIP() << "no instruction set of eight lanes here, or none compiled in";
}

TEST(ChildOrder, PutsTheNearestOfEveryChoiceOfEightChildrenOnTop) {
    where_eight_are_sorted([] {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> far(0, 10);
        for (std::uint32_t bits = 0; bits < 256; ++bits)
            for (int turn = 0; turn < 20; ++turn) {
                std::array<float, 8> entries;
                for (float& entry : entries)
                    entry = turn < 10 ? far(random) : std::floor(far(random) / 4);
                expect_the_nearest_last(entries, bits);
            }
    });
}

/// A network that sorts zeros and ones sorts all numbers.
TEST(ChildOrder, SortsAllZerosAndOnes) {
    where_eight_are_sorted([] {
        for (std::uint32_t ones = 0; ones < 256; ++ones) {
            std::array<float, 8> entries;
            for (std::uint32_t lane = 0; lane < 8; ++lane)
                entries[lane] = static_cast<float>(ones >> lane & 1);
            expect_the_nearest_last(entries, 255);
        }
    });
}

TEST(ChildOrder, TakesEntriesOfZeroAndOfInfinity) {
    where_eight_are_sorted([] {
        const float infinity = std::numeric_limits<float>::infinity();
        for (std::uint32_t bits = 0; bits < 256; ++bits) {
            expect_the_nearest_last({0, 0, 0, 0, 0, 0, 0, 0}, bits);
            expect_the_nearest_last({-0.0f, 1e-45f, infinity, 0, infinity, 1, 2e-38f, -0.0f}, bits);
        }
    });
}

} // namespace
} // namespace boxwood::detail
#endif
