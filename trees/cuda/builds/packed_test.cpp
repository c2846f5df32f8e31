#include "trees/builders/hilbert.h"
#include "trees/cuda/builds/packed_refit.cuh"
#include "trees/cuda/queries/packed_pairs.cuh"
#include "trees/cuda/testing/families.h"
#include "trees/cuda/testing/packed_layout.h"
#include "trees/executor.h"
#include "trees/testing/brute_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

namespace boxwood::cuda {
namespace {

void expect_same(const MadePackedLayout& made, const PackedLayout& wanted) {
    ASSERT_EQ(made.view.n, wanted.size());
    ASSERT_EQ(made.view.depth, wanted.depth());
    for (std::size_t l = 0; l < wanted.depth(); ++l) {
        const auto level = wanted.level(l);
        ASSERT_EQ(made.view.size(static_cast<unsigned>(l)), level.size());
        EXPECT_TRUE(
            same_bytes(made.blocks.data() + made.view.first[l], level.data(), level.size_bytes()))
            << "level " << l;
    }
    ASSERT_EQ(made.items.size(), wanted.items().size());
    EXPECT_TRUE(same_bytes(made.items.data(), wanted.items().data(), wanted.items().size_bytes()));
    if (wanted.size() > 0) {
        EXPECT_EQ(*made.bounds.data(), wanted.bounds());
    }
}

std::vector<Pair> counted_and_filled(const PackedView& a, const PackedView& b, bool is_self) {
    Array<std::uint64_t> at(a.leaves(), {});
    const auto count =
        is_self ? find_packed_pairs<true, Pass::count> : find_packed_pairs<false, Pass::count>;
    const auto fill =
        is_self ? find_packed_pairs<true, Pass::fill> : find_packed_pairs<false, Pass::fill>;
    std::fill_n(at.data(), at.size(), 0);
    count(a, b, {at.data(), nullptr, 0}, {});
    const std::uint64_t n = std::accumulate(at.data(), at.data() + at.size(), std::uint64_t{0});
    std::exclusive_scan(at.data(), at.data() + at.size(), at.data(), std::uint64_t{0});
    Array<Pair> pairs(n, {}); // not one place more
    fill(a, b, {at.data(), pairs.data(), 0}, {});
    return {pairs.data(), pairs.data() + n};
}

TEST(PackedOnDevice, IsTheLayoutOfTheCpu) {
    const auto serial = make_executor("serial", 1);
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        const auto order = HilbertBuilder{}.order(family.boxes, *serial);
        const PackedLayout wanted = PackedLayout::of_order(family.boxes, order.span(), *serial);
        for (std::uint64_t seed = 0; seed < seeds_for(family); ++seed) {
            on_host::set_seed(seed);
            expect_same(MadePackedLayout(family.boxes, order.span()), wanted);
        }
    }
}

TEST(PackedOnDevice, RefitsToNewBoxes) {
    const auto serial = make_executor("serial", 1);
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        const auto order = HilbertBuilder{}.order(family.boxes, *serial);
        std::vector<Box> moved = random_boxes(family.boxes.size(), .3f, 11);
        MadePackedLayout made(family.boxes, order.span());
        upload(Boxes(moved), made.boxes, {});
        fill_packed(made.view, made.boxes.data(), nullptr, made.bounds.data(), {});
        expect_same(made, PackedLayout::of_order(moved, order.span(), *serial));
    }
}

TEST(PackedOnDevice, RefitsSomeItems) {
    const auto serial = make_executor("serial", 1);
    for (const std::uint32_t n : {1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 1000u, 4097u})
        for (const std::uint32_t some : {0u, 1u, 2u, 40u, 300u, n}) {
            SCOPED_TRACE(std::to_string(some) + " of " + std::to_string(n));
            std::vector<Box> boxes = random_boxes(n, .2f, 5);
            const auto order = HilbertBuilder{}.order(boxes, *serial);
            MadePackedLayout made(boxes, order.span());
            Array<std::uint32_t> slots(n, {}), touched(made.blocks.size(), {});
            std::fill_n(touched.data(), touched.size(), 0u);
            launch({}, blocks_for(n, packed_threads), packed_threads, find_slots, made.view,
                   slots.data());
            for (std::uint32_t seed = 0; seed < 2; ++seed) {
                on_host::set_seed(seed);
                const std::vector<Box> to = random_boxes(n, .4f, 20 + seed);
                std::vector<std::uint32_t> moved; // some of them twice
                for (std::uint32_t i = 0; i < some; ++i)
                    moved.push_back((i / 3 * 2 + i % 3) * 7919 % n);
                for (const std::uint32_t item : moved)
                    boxes[item] = to[item];
                upload(Boxes(boxes), made.boxes, {});
                refit_packed_items(made.view, made.boxes.data(),
                                   {moved.data(), some, slots.data(), touched.data()},
                                   made.bounds.data(), {});
                expect_same(made, PackedLayout::of_order(boxes, order.span(), *serial));
                EXPECT_TRUE(std::all_of(touched.data(), touched.data() + touched.size(),
                                        [](std::uint32_t t) { return t == 0; }));
            }
        }
}

TEST(PackedPairsOnDevice, AreThoseOfBruteForce) {
    const auto serial = make_executor("serial", 1);
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        const auto order = HilbertBuilder{}.order(family.boxes, *serial);
        const MadePackedLayout made(family.boxes, order.span());
        const std::vector<Pair> wanted = brute_force(family.boxes);
        std::vector<Pair> first;
        for (std::uint64_t seed = 0; seed < fibre_seeds; ++seed) {
            on_host::set_seed(seed);
            const std::vector<Pair> found = counted_and_filled(made.view, made.view, true);
            ASSERT_EQ(sorted(found), wanted) << "seed " << seed;
            if (seed == 0)
                first = found;
            ASSERT_EQ(found, first) << "the order depends on the seed " << seed;
        }
    }
}

TEST(PackedPairsOnDevice, OverflowIsCounted) {
    const auto serial = make_executor("serial", 1);
    const std::vector<Box> boxes = random_boxes(600, .2f, 3);
    const auto order = HilbertBuilder{}.order(boxes, *serial);
    const MadePackedLayout made(boxes, order.span());
    const std::vector<Pair> wanted = brute_force(boxes);
    for (const std::size_t room : {std::size_t{0}, wanted.size() / 2, wanted.size()}) {
        Array<Pair> pairs(room, {});
        std::uint64_t n = 0;
        find_packed_pairs<true, Pass::capped>(made.view, made.view, {&n, pairs.data(), room}, {});
        EXPECT_EQ(n, wanted.size());
        const std::vector<Pair> found = sorted({pairs.data(), pairs.data() + room});
        EXPECT_TRUE(std::ranges::includes(wanted, found));
        EXPECT_EQ(std::ranges::adjacent_find(found), found.end());
    }
}

TEST(PackedPairsOnDevice, OfTwoSets) {
    const auto serial = make_executor("serial", 1);
    for (const auto& [n, m] :
         {std::pair{1, 1}, {17, 300}, {300, 17}, {257, 4097}, {0, 5}, {5, 0}}) {
        const std::vector<Box> a = random_boxes(static_cast<std::size_t>(n), .2f, 1),
                               b = random_boxes(static_cast<std::size_t>(m), .05f, 2);
        const auto order_a = HilbertBuilder{}.order(a, *serial),
                   order_b = HilbertBuilder{}.order(b, *serial);
        const MadePackedLayout on_a(a, order_a.span()), on_b(b, order_b.span());
        std::vector<Pair> wanted;
        for (std::uint32_t i = 0; i < a.size(); ++i)
            for (std::uint32_t j = 0; j < b.size(); ++j)
                if (overlaps(a[i], b[j]))
                    wanted.push_back({i, j});
        EXPECT_EQ(sorted(counted_and_filled(on_a.view, on_b.view, false)), wanted)
            << n << " and " << m;
    }
}

} // namespace
} // namespace boxwood::cuda
