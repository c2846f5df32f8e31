#include "trees/world/bodies/detail/sort_pairs.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace boxwood::detail {
namespace {

TEST(SortPairs, MayBeNoneOrAllOfOneBody) {
    std::vector<Pair> pairs;
    sort_pairs(pairs, 0);
    EXPECT_TRUE(pairs.empty());
    std::vector<Pair> expected;
    for (std::uint32_t i = 1; i < 1000; ++i)
        expected.push_back({0, i});
    pairs.assign(expected.rbegin(), expected.rend());
    sort_pairs(pairs, 1000);
    EXPECT_EQ(pairs, expected);
}

/// Few and many for the bodies there are, with some twice and bodies that are in none.
TEST(SortPairs, AreAscending) {
    std::mt19937 random(1);
    for (const std::uint32_t n : {1u, 2u, 100u, 3000u})
        for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 500u, 20'000u}) {
            std::uniform_int_distribution<std::uint32_t> body(0, n - 1);
            std::vector<Pair> pairs(count);
            for (Pair& pair : pairs)
                pair = {body(random), body(random) % 7 == 0 ? n - 1 : body(random)};
            std::vector<Pair> expected = pairs;
            std::ranges::sort(expected);
            sort_pairs(pairs, n);
            EXPECT_EQ(pairs, expected) << n << " bodies, " << count << " pairs";
        }
}

} // namespace
} // namespace boxwood::detail
