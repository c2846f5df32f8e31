#include "trees/cuda/primitives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace boxwood::cuda {
namespace {

constexpr std::size_t sizes[] = {0, 1, 2, 15, 16, 17, 255, 256, 257, 4097};

template <class Key> void expect_sorted(std::size_t n, int low, int high, Key most) {
    std::mt19937_64 random(n);
    std::uniform_int_distribution<Key> any(0, most);
    std::vector<Key> keys(n), sorted_keys(n);
    std::ranges::generate(keys, [&] { return any(random); });
    std::vector<std::uint32_t> values(n), sorted_values(n), order(n);
    std::ranges::generate(values, random);
    Spare spare;
    sort_by_bits(keys.data(), sorted_keys.data(), values.data(), sorted_values.data(), n, low, high,
                 spare, {});
    constexpr int all = std::numeric_limits<Key>::digits;
    const Key bits = low == high ? Key{0} : static_cast<Key>(~Key{0}) >> (all - high) >> low << low;
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return keys[i] & bits; });
    for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(sorted_keys[i], keys[order[i]])
            << "of " << n << ", bits " << low << " to " << high;
        ASSERT_EQ(sorted_values[i], values[order[i]]);
    }
}

TEST(Primitives, SortsByTheBitsGivenAndKeepsTheOrderOfEqualOnes) {
    for (const std::size_t n : sizes) {
        for (const auto& [low, high] : {std::pair{0, 32}, {0, 30}, {7, 21}, {31, 32}, {5, 5}})
            for (const std::uint32_t most : {~0u, 3u << 7})
                expect_sorted<std::uint32_t>(n, low, high, most);
        for (const auto& [low, high] : {std::pair{0, 64}, {0, 63}, {30, 35}, {63, 64}})
            for (const std::uint64_t most : {~std::uint64_t{0}, std::uint64_t{5} << 32})
                expect_sorted<std::uint64_t>(n, low, high, most);
    }
}

template <class Number> void expect_sums(std::size_t n) {
    std::vector<Number> numbers(n + 1);
    for (std::size_t i = 0; i <= n; ++i)
        numbers[i] = static_cast<Number>(i * 977 % 64) << (sizeof(Number) * 4);
    std::vector<Number> wanted{0};
    std::partial_sum(numbers.begin(), numbers.end() - 1, std::back_inserter(wanted));
    Spare spare;
    scan(numbers.data(), n, spare, {});
    EXPECT_EQ(numbers, wanted);
}

TEST(Primitives, SumsUpWithTheTotalAtTheEnd) {
    for (const std::size_t n : sizes) {
        expect_sums<std::uint32_t>(n);
        expect_sums<std::uint64_t>(n);
    }
}

TEST(Primitives, SelectsThePlacesOfFlags) {
    for (const std::size_t n : sizes)
        for (const unsigned every : {1u, 2u, 100u}) {
            std::vector<std::uint8_t> flags(n);
            std::vector<std::uint32_t> wanted, to(n);
            for (std::uint32_t i = 0; i < n; ++i)
                if (i % every == every - 1) {
                    flags[i] = static_cast<std::uint8_t>(1 + i % 3);
                    wanted.push_back(i);
                }
            Spare spare;
            std::uint32_t n_to = 7;
            select(flags.data(), n, to.data(), &n_to, spare, {});
            to.resize(n_to);
            EXPECT_EQ(to, wanted);
        }
}

} // namespace
} // namespace boxwood::cuda
