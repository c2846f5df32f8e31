#include "trees/buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <new>
#include <thread>
#include <utility>
#include <vector>

namespace boxwood {
namespace {

constexpr std::size_t MiB = std::size_t{1} << 20;

template <class T> std::uintptr_t address(const Buffer<T>& b) {
    return reinterpret_cast<std::uintptr_t>(b.data());
}

TEST(Buffer, IsAlignedToLinesAndLargeOnesToHugePages) {
    for (const std::size_t bytes : {std::size_t{1}, std::size_t{63}, 65 * MiB / 64, 4 * MiB - 1})
        EXPECT_EQ(address(Buffer<char>(bytes)) % 64, 0u) << bytes;
    for (const std::size_t bytes : {4 * MiB, 4 * MiB + 1, 33 * MiB})
        EXPECT_EQ(address(Buffer<char>(bytes)) % (2 * MiB), 0u) << bytes;
}

TEST(Buffer, ThrowsForMoreThanThereIs) { EXPECT_THROW(allocate_lines(SIZE_MAX), std::bad_alloc); }

// Whatever was freed before and is handed out again: no byte belongs to two buffers.
TEST(Buffer, LargeOnesOfManySizesAndThreadsNeverShareMemory) {
    const auto churn = [](std::uint64_t seed) {
        std::vector<Buffer<std::uint64_t>> held;
        std::vector<std::uint64_t> marks;
        for (std::uint64_t step = 0; step < 24; ++step) {
            const std::uint64_t mark = seed << 32 | step;
            const std::size_t size = (4 + (step * 7 + seed * 3) % 13) * MiB / 8 + step;
            Buffer<std::uint64_t> made(size);
            // A write in each page; the last element is the end of what was asked for.
            for (std::size_t i = 0; i < size; i += 512)
                made[i] = mark;
            made[size - 1] = mark;
            held.push_back(std::move(made));
            marks.push_back(mark);
            if (held.size() == 4) {
                const std::size_t out = step % 4;
                for (std::size_t i = 0; i < held[out].size(); i += 512)
                    ASSERT_EQ(held[out][i], marks[out]);
                ASSERT_EQ(held[out][held[out].size() - 1], marks[out]);
                held.erase(held.begin() + static_cast<std::ptrdiff_t>(out));
                marks.erase(marks.begin() + static_cast<std::ptrdiff_t>(out));
            }
        }
    };
    std::vector<std::thread> threads;
    for (std::uint64_t t = 0; t < 4; ++t)
        threads.emplace_back(churn, t);
    for (std::thread& t : threads)
        t.join();
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
TEST(Buffer, LargeMemoryIsHandedOutAgain) {
    std::uintptr_t before = 0;
    {
        const Buffer<char> first(41 * MiB);
        before = address(first);
    }
    const Buffer<char> much_smaller(20 * MiB);
    EXPECT_NE(address(much_smaller), before);
    const Buffer<char> alike(40 * MiB);
    EXPECT_EQ(address(alike), before);
}

/// Of address space, in bytes.
std::size_t size_of_process() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * 4096;
}

TEST(Buffer, KeepsNoMoreThanAQuarterOfAGiB) {
    const std::size_t before = size_of_process(),
                      max_bytes = before + 257 * MiB; // 1 of the heap's own
    {
        std::vector<Buffer<char>> many;
        for (int i = 0; i < 16; ++i)
            many.emplace_back(30 * MiB);
        EXPECT_GE(size_of_process(), before + 200 * MiB); // some are those kept before
    }
    EXPECT_LE(size_of_process(), max_bytes);
    { const Buffer<char> larger_than_all(300 * MiB); }
    EXPECT_LE(size_of_process(), max_bytes);
}
#endif

} // namespace
} // namespace boxwood
