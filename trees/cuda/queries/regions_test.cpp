#include "trees/builder.h"
#include "trees/cuda/builds/built_tree.cuh"
#include "trees/cuda/queries/nearest.cuh"
#include "trees/cuda/queries/packed_queries.cuh"
#include "trees/cuda/queries/regions.cuh"
#include "trees/cuda/testing/families.h"
#include "trees/cuda/testing/packed_layout.h"
#include "trees/cuda/testing/radix_tree.h"
#include "trees/layout.h"
#include "trees/testing/region_queries.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace boxwood::cuda {
namespace {

std::unique_ptr<AnyLayout> on_cpu(Boxes boxes) {
    return find_layout("binary").make(make_builder("median")(boxes, serial()), serial());
}

/// The items of each region, at[i] to at[i + 1], in the order in which they were found.
struct Found {
    std::vector<std::uint64_t> at;
    std::vector<std::uint32_t> items;

    bool operator==(const Found&) const = default;
    std::vector<Pair> pairs() const {
        std::vector<Pair> all;
        for (std::uint32_t query = 0; query + 1 < at.size(); ++query)
            for (std::uint64_t i = at[query]; i < at[query + 1]; ++i)
                all.push_back({query, items[i]});
        return all;
    }
};

template <class Region>
Found counted_and_filled(const RadixTreeView& tree, const std::vector<Region>& regions) {
    const auto n = static_cast<std::uint32_t>(regions.size());
    Found found{std::vector<std::uint64_t>(n + 1), {}};
    find_in_regions<Pass::count>(tree, regions.data(), n, {found.at.data(), nullptr, 0}, {});
    std::exclusive_scan(found.at.begin(), found.at.end(), found.at.begin(), std::uint64_t{0});
    found.items.resize(found.at[n]);
    find_in_regions<Pass::fill>(tree, regions.data(), n, {found.at.data(), found.items.data(), 0},
                                {});
    return found;
}

template <class Region>
void expect_capped(const RadixTreeView& tree, const std::vector<Region>& regions,
                   const std::vector<Pair>& wanted) {
    for (const std::size_t room : {std::size_t{0}, wanted.size() / 2, wanted.size()}) {
        Array<Pair> pairs(room, {});
        std::uint64_t n = 0;
        find_in_regions<Pass::capped>(tree, regions.data(),
                                      static_cast<std::uint32_t>(regions.size()),
                                      {&n, pairs.data(), room}, {});
        EXPECT_EQ(n, wanted.size());
        std::sort(pairs.data(), pairs.data() + room);
        EXPECT_TRUE(std::includes(wanted.begin(), wanted.end(), pairs.data(), pairs.data() + room));
    }
}

template <class Region>
void expect_found(const BoxFamily& family, const std::vector<Region>& regions,
                  const std::vector<Pair>& wanted) {
    Found first;
    const std::uint64_t seeds = family.boxes.size() > 20 ? 2 : fibre_seeds;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        on_host::set_seed(seed);
        const MadeRadixTree made(family.boxes);
        Found found = counted_and_filled(made.view, regions);
        if (seed > 0) {
            ASSERT_EQ(found, first) << "the order depends on the seed " << seed;
            continue;
        }
        first = found;
        sort_answers(found.at.data(), static_cast<std::uint32_t>(regions.size()),
                     found.items.data(), {});
        ASSERT_EQ(found.pairs(), wanted);
        expect_capped(made.view, regions, wanted);
    }
}

TEST(RegionsOnDevice, AreThoseOfTheCpu) {
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        const auto layout = on_cpu(family.boxes);
        const QueriesOfRegions q = queries_for(family.boxes);
        std::vector<Pair> in_points, in_boxes, in_balls;
        AppendPairs to_points(in_points), to_boxes(in_boxes), to_balls(in_balls);
        layout->points(q.points, serial(), to_points);
        layout->regions(q.boxes, serial(), to_boxes);
        layout->regions(q.balls, serial(), to_balls);
        expect_found(family, q.points, in_points);
        expect_found(family, q.boxes, in_boxes);
        expect_found(family, q.balls, in_balls);
    }
}

TEST(NearestOnDevice, AreThoseOfTheCpu) {
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        const auto layout = on_cpu(family.boxes);
        const std::vector<Vec3<float>> points = queries_for(family.boxes).points;
        for (const std::uint32_t k : {0u, 1u, 2u, 8u, 100u}) {
            std::vector<Neighbour> wanted(k * points.size());
            layout->nearest(points, k, serial(), wanted);
            for (std::uint64_t seed = 0; seed < (k == 8 ? seeds_for(family) : 1); ++seed) {
                on_host::set_seed(seed);
                const MadeRadixTree made(family.boxes);
                std::vector<Neighbour> found(wanted.size());
                find_nearest(made.view, points.data(), static_cast<std::uint32_t>(points.size()), k,
                             found.data(), {});
                ASSERT_EQ(found, wanted) << "k = " << k;
            }
            if (k != 8 || family.boxes.size() > 300)
                continue;
            BuiltTree made({.form = Form::hploc});
            made.build(family.boxes.data(), family.boxes.size(), {});
            std::vector<Neighbour> found(wanted.size());
            find_nearest<2>(BinaryTree{made.hploc(), family.boxes.data(), made.parents()},
                            points.data(), static_cast<std::uint32_t>(points.size()), k,
                            found.data(), {});
            ASSERT_EQ(found, wanted) << "by area, nearly without a stack, k = " << k;
        }
    }
}

TEST(AnswersOnDevice, AreSortedWhateverTheirNumber) {
    std::vector<std::uint64_t> at{0};
    for (const std::uint64_t n : {0, 1, 2, 3, 7, 8, 9, 31, 255, 256, 257, 1000, 3, 5000, 1})
        at.push_back(at.back() + n);
    const auto n = static_cast<std::uint32_t>(at.size() - 1);
    std::mt19937 random(3);
    std::vector<std::uint32_t> numbers(at.back());
    for (std::uint32_t& x : numbers)
        x = static_cast<std::uint32_t>(random() % 3000);
    std::vector<std::uint32_t> wanted = numbers;
    for (std::uint32_t i = 0; i < n; ++i)
        std::sort(wanted.data() + at[i], wanted.data() + at[i + 1]);
    for (std::uint64_t seed = 0; seed < fibre_seeds; ++seed) {
        on_host::set_seed(seed);
        std::vector<std::uint32_t> found = numbers;
        sort_answers(at.data(), n, found.data(), {});
        ASSERT_EQ(found, wanted);
    }
}

} // namespace
} // namespace boxwood::cuda
