#include "trees/cuda/queries/binary_pairs.cuh"

#include "trees/cuda/queries/nearest.cuh"
#include "trees/testing/brute_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace boxwood::cuda {
namespace {

/// Each node has one item, left or right, and all others below.
struct Chain {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> items, parents;
    std::vector<BinaryNode> nodes;
    std::uint32_t root = 0;
    BinaryTree tree;

    Chain(std::uint32_t n, std::uint32_t left_every)
        : boxes(n), items(n), parents(2 * n), nodes(n - 1) {
        for (std::uint32_t i = 0; i < n; ++i)
            boxes[i] = {{static_cast<float>(i), 0, 0}, {static_cast<float>(i + i % 5), 1, 1}};
        std::iota(items.begin(), items.end(), 0u);
        std::uint32_t below = (n - 1) | RadixNode::leaf_bit;
        Box box = boxes[n - 1];
        for (std::uint32_t i = n - 1; i-- > 0;) {
            box.extend(boxes[i]);
            const std::uint32_t item = i | RadixNode::leaf_bit;
            nodes[i] =
                i % left_every == 0 ? BinaryNode{box, item, below} : BinaryNode{box, below, item};
            below = i;
        }
        std::vector<std::uint32_t> met(n);
        const BinaryView view{n, items.data(), nodes.data(), &root};
        launch(Stream{}, 1, 512, find_parents, view, parents.data(), met.data());
        tree = {view, boxes.data(), parents.data()};
    }
};

/// More than the ring holds, of which the first ones are lost and found by the parents.
TEST(BinaryPairsOnDevice, OfATreeDeeperThanTheStack) {
    for (const std::uint32_t left_every : {1u, 2u, 7u, 1000u}) {
        const Chain chain(300, left_every);
        std::uint64_t n = 0;
        std::vector<Pair> pairs(20'000);
        find_binary_pairs<true, Pass::capped>(chain.tree, chain.tree,
                                              {&n, pairs.data(), pairs.size()}, {});
        pairs.resize(n);
        std::ranges::sort(pairs);
        EXPECT_EQ(pairs, brute_force(chain.boxes)) << left_every;

        // All with all: that waits for as many nodes as there are.
        std::vector<Box> same(300, chain.boxes[0]);
        for (Box& box : same)
            box.max.x = 1000;
        BinaryTree others = chain.tree;
        others.boxes = same.data();
        n = 0;
        find_binary_pairs<false, Pass::capped>(others, others, {&n, nullptr, 0}, {});
        EXPECT_EQ(n, 300u * 300u) << left_every;
    }
}

/// Where the stack is full subtrees are searched without one.
TEST(NearestOnDevice, OfATreeDeeperThanTheStack) {
    for (const std::uint32_t left_every : {1u, 2u, 7u, 1000u}) {
        const Chain chain(300, left_every);
        for (const float x : {-1.f, 150.5f, 320.f}) {
            const Vec3<float> point{x, 2, 0};
            std::vector<Neighbour> wanted;
            for (std::uint32_t i = 0; i < 300; ++i)
                wanted.push_back({i, squared_distance(point, chain.boxes[i])});
            std::ranges::stable_sort(wanted, {}, &Neighbour::squared_distance);
            for (const std::uint32_t k : {1u, 5u, 300u}) {
                std::vector<Neighbour> found(k), by_little(k);
                find_nearest(chain.tree, &point, 1, k, found.data(), {});
                find_nearest<2>(chain.tree, &point, 1, k, by_little.data(), {});
                const std::vector<Neighbour> first(wanted.begin(), wanted.begin() + k);
                EXPECT_EQ(found, first) << x;
                EXPECT_EQ(by_little, first) << x;
            }
        }
    }
}

} // namespace
} // namespace boxwood::cuda
