#include "trees/cuda/queries/worlds.cuh"
#include "trees/cuda/testing/families.h"
#include "trees/testing/brute_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace boxwood::cuda {
namespace {

/// All worlds in one tree in the device's memory.
struct MadeWorlds {
    std::vector<std::uint32_t> first{0};
    std::vector<Box> boxes, leaves;
    std::vector<std::uint64_t> codes;
    std::vector<std::uint32_t> items, met;
    std::vector<RadixNode> nodes;
    std::uint32_t root = 0;
    WorldsView worlds;
    RadixTreeView tree;

    explicit MadeWorlds(const std::vector<std::vector<Box>>& of) {
        for (const std::vector<Box>& world : of) {
            boxes.insert(boxes.end(), world.begin(), world.end());
            first.push_back(static_cast<std::uint32_t>(boxes.size()));
        }
        const auto n = static_cast<std::uint32_t>(boxes.size());
        leaves.resize(n);
        codes.resize(n);
        items.resize(n);
        met.resize(n);
        nodes.resize(n);
        worlds = {static_cast<std::uint32_t>(of.size()), first.data(), boxes.data(), codes.data(),
                  items.data()};
        tree = {n, leaves.data(), items.data(), nodes.data(), &root};
        order_worlds(worlds, n, {});
        make_radix_tree(tree, codes.data(), boxes.data(), met.data(), {});
    }

    /// Pairs, and where those of each world begin.
    std::pair<std::vector<Pair>, std::vector<std::uint64_t>> pairs() const {
        std::vector<std::uint64_t> at(tree.n + 1);
        find_world_pairs<Pass::count>(worlds, tree, {at.data(), nullptr, 0}, {});
        std::exclusive_scan(at.begin(), at.end(), at.begin(), std::uint64_t{0});
        std::vector<Pair> all(at.back());
        find_world_pairs<Pass::fill>(worlds, tree, {at.data(), all.data(), 0}, {});
        std::vector<std::uint64_t> begin;
        for (const std::uint32_t slot : first)
            begin.push_back(at[slot]);
        return {all, begin};
    }
};

/// The pairs of each world, ascending, numbered over all.
std::vector<Pair> by_brute_force(const std::vector<std::vector<Box>>& worlds) {
    std::vector<Pair> all;
    std::uint32_t first = 0;
    for (const std::vector<Box>& world : worlds) {
        for (const Pair pair : brute_force(world))
            all.push_back({first + pair.a, first + pair.b});
        first += static_cast<std::uint32_t>(world.size());
    }
    return all;
}

void expect_pairs(const std::vector<std::vector<Box>>& worlds, std::uint64_t seeds) {
    const std::vector<Pair> wanted = by_brute_force(worlds);
    std::vector<Pair> first;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        on_host::set_seed(seed);
        const MadeWorlds made(worlds);
        auto [found, begin] = made.pairs();
        if (seed == 0)
            first = found;
        ASSERT_EQ(found, first) << "the order depends on the seed " << seed;
        for (std::size_t w = 0; w < worlds.size(); ++w)
            for (std::uint64_t i = begin[w]; i < begin[w + 1]; ++i)
                ASSERT_TRUE(found[i].a >= made.first[w] && found[i].b < made.first[w + 1]);
        std::ranges::sort(found);
        ASSERT_EQ(found, wanted);
    }
}

TEST(WorldsOnDevice, HavePairsWithinEachWorldAlone) {
    std::vector<std::vector<Box>> worlds;
    for (std::uint32_t round = 0; round < 6; ++round)
        for (const std::size_t n : {0u, 1u, 15u, 16u, 17u, 40u, 0u, 2u, 33u})
            worlds.push_back(random_boxes(n, .3f, round)); // at the same place
    expect_pairs(worlds, fibre_seeds);
    std::ranges::reverse(worlds);
    expect_pairs(worlds, 1);
}

TEST(WorldsOnDevice, OfAllFamilies) {
    std::vector<std::vector<Box>> worlds;
    for (const BoxFamily& family : device_families()) {
        if (family.boxes.size() < 1000)
            worlds.push_back(family.boxes);
        expect_pairs({family.boxes}, family.boxes.size() < 1000 ? 2 : 1); // by a block
    }
    expect_pairs(worlds, 2);
    expect_pairs({}, 1);
    expect_pairs({{}, {}, {}}, 1);
}

TEST(WorldsOnDevice, OverflowIsCounted) {
    std::vector<std::vector<Box>> worlds;
    for (std::uint32_t w = 0; w < 20; ++w)
        worlds.push_back(random_boxes(40, .4f, w));
    const std::vector<Pair> wanted = by_brute_force(worlds);
    const MadeWorlds made(worlds);
    for (const std::size_t room : {std::size_t{0}, wanted.size() / 2, wanted.size()}) {
        Array<Pair> pairs(room, {});
        std::uint64_t n = 0;
        find_world_pairs<Pass::capped>(made.worlds, made.tree, {&n, pairs.data(), room}, {});
        EXPECT_EQ(n, wanted.size());
        std::sort(pairs.data(), pairs.data() + room);
        EXPECT_TRUE(std::includes(wanted.begin(), wanted.end(), pairs.data(), pairs.data() + room));
    }
}

} // namespace
} // namespace boxwood::cuda
