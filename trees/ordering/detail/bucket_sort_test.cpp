#include "trees/ordering/detail/bucket_sort.h"
#include "trees/testing/every_executor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace boxwood {
using namespace detail;
namespace {

struct CodeFamily {
    std::string name;
    std::vector<std::uint32_t> codes; ///< of 30 bits
};

std::vector<CodeFamily> code_families() {
    std::vector<CodeFamily> all;
    std::mt19937 random(7);
    const auto add = [&](std::string name, std::size_t n, const auto& code) {
        CodeFamily family{std::move(name) + " " + std::to_string(n), {}};
        for (std::size_t i = 0; i < n; ++i)
            family.codes.push_back(code(i) & 0x3fffffffu);
        all.push_back(std::move(family));
    };
    const auto number = [](std::size_t i) { return static_cast<std::uint32_t>(i); };
    for (const std::size_t n : {0u, 1u, 2u, 17u, 2048u, 2049u, 30000u}) {
        add("random", n, [&](std::size_t) { return static_cast<std::uint32_t>(random()); });
        add("all the same", n, [&](std::size_t) { return 0x2aaaaaaau; });
        add("ascending", n, [&](std::size_t i) { return 1000 * number(i); });
        add("descending", n, [&](std::size_t i) { return 0x3fffffffu - number(i); });
        add("nine of each", n, [&](std::size_t i) { return number(i) / 9 * 7919 * 1024; });
        add("one cell and one far away", n, [&](std::size_t i) {
            return i == 1 ? 0x3fffffffu : static_cast<std::uint32_t>(random()) & 0xffffu;
        });
        add("denser and denser", n,
            [&](std::size_t) { return static_cast<std::uint32_t>(random()) >> (random() % 31); });
    }
    return all;
}

std::vector<std::uint64_t> sorted(const std::vector<std::uint32_t>& codes, int bits, Sorted how,
                                  const Executor& executor, std::size_t& alike) {
    std::vector<std::uint64_t> found(codes.size(), ~std::uint64_t{0});
    alike = bucket_sort(
        codes.size(), bits,
        [&](std::size_t first, std::span<std::uint32_t> to) {
            std::copy_n(codes.begin() + static_cast<std::ptrdiff_t>(first), to.size(), to.begin());
        },
        how, executor,
        [&](std::size_t first, std::span<const std::uint64_t> records, std::size_t) {
            std::ranges::copy(records, found.begin() + static_cast<std::ptrdiff_t>(first));
        });
    return found;
}

TEST(BucketSort, AgreesWithTheStandardSortOnEveryFamilyAndExecutor) {
    for (const CodeFamily& family : code_families()) {
        SCOPED_TRACE(family.name);
        std::vector<std::uint64_t> truth;
        for (std::size_t i = 0; i < family.codes.size(); ++i)
            truth.push_back(std::uint64_t{family.codes[i]} << 32 | i);
        std::ranges::sort(truth);
        for (const auto& [name, executor] : every_executor()) {
            std::size_t alike = 0;
            EXPECT_EQ(sorted(family.codes, 30, Sorted::exactly, *executor, alike), truth) << name;
        }
    }
}

TEST(BucketSort, InBlocksIsTheSameOnEveryExecutorAndNowhereFarFromSorted) {
    for (const CodeFamily& family : code_families()) {
        SCOPED_TRACE(family.name);
        std::vector<std::uint32_t> codes = family.codes;
        for (std::size_t i = 0; i < codes.size(); ++i)
            codes[i] |= static_cast<std::uint32_t>(i % 3) << 30;
        std::size_t alike = 0;
        const auto found = sorted(codes, 32, Sorted::in_blocks, serial(), alike);
        for (const auto& [name, executor] : parallel_executors()) {
            std::size_t other = 0;
            EXPECT_EQ(sorted(codes, 32, Sorted::in_blocks, *executor, other), found) << name;
            EXPECT_EQ(other, alike) << name;
        }
        std::vector<std::uint64_t> truth = found;
        std::ranges::sort(truth);
        for (std::size_t i = 0; i < found.size(); ++i) {
            const std::size_t item = found[i] & 0xffffffffu;
            ASSERT_EQ(found[i] >> 32, codes.at(item));
            const auto place = std::ranges::lower_bound(truth, found[i]) - truth.begin();
            ASSERT_LT(std::abs(place - static_cast<std::ptrdiff_t>(i)), 16);
        }
        EXPECT_EQ(std::ranges::unique(truth).begin(), truth.end());
    }
}

TEST(BucketSort, CountsItemsThatShareTheirCodeWithManyOthers) {
    std::size_t alike = 0;
    sorted(std::vector<std::uint32_t>(5000, 3u), 30, Sorted::in_blocks, serial(), alike);
    EXPECT_EQ(alike, 5000u);
    std::vector<std::uint32_t> codes(5000);
    std::iota(codes.begin(), codes.end(), 0u);
    sorted(codes, 30, Sorted::exactly, serial(), alike);
    EXPECT_EQ(alike, 0u);
    std::fill_n(codes.begin(), 40, 0u);
    sorted(codes, 30, Sorted::exactly, serial(), alike);
    EXPECT_EQ(alike, 40u);
}

} // namespace
} // namespace boxwood
