#include "trees/cuda/queries/radix_pairs.cuh"
#include "trees/cuda/testing/families.h"
#include "trees/cuda/testing/radix_tree.h"
#include "trees/testing/brute_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <vector>

namespace boxwood::cuda {
namespace {

/// The tree by its definition, from the top: parts a range of slots where the highest bit of codes
/// and slots changes. Gives the box of what is below.
Box expect_subtree(const MadeRadixTree& made, std::uint32_t ref, std::uint32_t first,
                   std::uint32_t last) {
    const RadixTreeView& tree = made.view;
    if (first == last) {
        EXPECT_EQ(ref, first | RadixNode::leaf_bit);
        EXPECT_EQ(tree.leaves[first], made.boxes.data()[tree.items[first]]);
        return tree.leaves[first];
    }
    const auto key = [&](std::uint32_t slot) { return std::pair{made.codes.data()[slot], slot}; };
    const auto [code_a, slot_a] = key(first);
    const auto [code_b, slot_b] = key(last);
    std::uint32_t split = first; // the last slot whose bit is not set
    while (split + 1 < last) {
        const auto [code, slot] = key(split + 1);
        const bool set = code_a != code_b ? (code & std::bit_floor(code_a ^ code_b)) != 0
                                          : (slot & std::bit_floor(slot_a ^ slot_b)) != 0;
        if (set)
            break;
        ++split;
    }
    EXPECT_EQ(ref, split);
    if (ref != split)
        return {};
    const RadixNode& node = tree.nodes[ref];
    EXPECT_EQ(node.last, last);
    Box box = expect_subtree(made, node.left, first, split);
    box.extend(expect_subtree(made, node.right, split + 1, last));
    EXPECT_EQ(node.box, box);
    return box;
}

TEST(RadixTreeOnDevice, IsThatOfTheDefinition) {
    for (const BoxFamily& family : device_families())
        for (const Curve curve : {Curve::morton, Curve::hilbert})
            for (std::uint64_t seed = 0; seed < fibre_seeds; ++seed) {
                SCOPED_TRACE(family.name);
                on_host::set_seed(seed);
                const MadeRadixTree made(family.boxes, curve);
                if (made.view.n > 0)
                    expect_subtree(made, *made.view.root, 0, made.view.n - 1);
                ASSERT_FALSE(HasFailure());
            }
}

TEST(RadixTreeOnDevice, RefitsToNewBoxes) {
    MadeRadixTree made(random_boxes(1000, .1f, 4));
    const std::vector<Box> moved = random_boxes(1000, .1f, 5);
    upload(Boxes(moved), made.boxes, {});
    make_radix_tree(made.view, made.codes.data(), made.boxes.data(), made.met.data(), {});
    expect_subtree(made, *made.view.root, 0, 999);
}

template <bool is_self, Traversal traversal>
std::vector<Pair> counted_and_filled(const RadixTreeView& a, const RadixTreeView& b) {
    std::vector<std::uint64_t> at(a.n, 0);
    find_radix_pairs<is_self, Pass::count, traversal>(a, b, {at.data(), nullptr, 0}, {});
    const std::uint64_t n = std::accumulate(at.begin(), at.end(), std::uint64_t{0});
    std::exclusive_scan(at.begin(), at.end(), at.begin(), std::uint64_t{0});
    Array<Pair> pairs(n, {});
    find_radix_pairs<is_self, Pass::fill, traversal>(a, b, {at.data(), pairs.data(), 0}, {});
    return {pairs.data(), pairs.data() + n};
}

TEST(RadixPairsOnDevice, AreThoseOfBruteForce) {
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        const MadeRadixTree made(family.boxes);
        const std::vector<Pair> wanted = brute_force(family.boxes);
        const std::vector<Pair> by_stack =
            counted_and_filled<true, Traversal::stack>(made.view, made.view);
        ASSERT_EQ(sorted(by_stack), wanted);
        EXPECT_EQ((counted_and_filled<true, Traversal::ropes>(made.view, made.view)), by_stack);
    }
}

TEST(RadixPairsOnDevice, OverflowIsCounted) {
    const std::vector<Box> boxes = random_boxes(600, .2f, 3);
    const MadeRadixTree made(boxes);
    const std::vector<Pair> wanted = brute_force(boxes);
    for (const std::size_t room : {std::size_t{0}, wanted.size() / 2, wanted.size()})
        for (std::uint64_t seed = 0; seed < fibre_seeds; ++seed) {
            on_host::set_seed(seed);
            Array<Pair> pairs(room, {});
            std::uint64_t n = 0;
            find_radix_pairs<true, Pass::capped, Traversal::ropes>(made.view, made.view,
                                                                   {&n, pairs.data(), room}, {});
            EXPECT_EQ(n, wanted.size());
            const std::vector<Pair> found = sorted({pairs.data(), pairs.data() + room});
            EXPECT_TRUE(std::ranges::includes(wanted, found));
            EXPECT_EQ(std::ranges::adjacent_find(found), found.end());
        }
}

TEST(RadixPairsOnDevice, OfTwoSets) {
    for (const auto& [n, m] :
         {std::pair{1, 1}, {17, 300}, {300, 17}, {257, 4097}, {0, 5}, {5, 0}}) {
        const std::vector<Box> a = random_boxes(static_cast<std::size_t>(n), .2f, 1),
                               b = random_boxes(static_cast<std::size_t>(m), .05f, 2);
        const MadeRadixTree on_a(a), on_b(b);
        std::vector<Pair> wanted;
        for (std::uint32_t i = 0; i < a.size(); ++i)
            for (std::uint32_t j = 0; j < b.size(); ++j)
                if (overlaps(a[i], b[j]))
                    wanted.push_back({i, j});
        EXPECT_EQ(sorted(counted_and_filled<false, Traversal::stack>(on_a.view, on_b.view)),
                  wanted);
        EXPECT_EQ(sorted(counted_and_filled<false, Traversal::ropes>(on_a.view, on_b.view)),
                  wanted);
    }
}

} // namespace
} // namespace boxwood::cuda
