#include "trees/cuda/on_host.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace boxwood::on_host {
namespace {

using ::testing::HasSubstr;

std::string fault_of(unsigned n_threads, const std::function<void()>& thread) {
    try {
        run_grid(1, n_threads, thread);
    } catch (const Fault& fault) {
        return fault.what();
    }
    return "";
}

TEST(OnHost, EveryThreadOfEveryBlockRunsOnce) {
    std::vector<int> runs(7 * 96);
    run_grid(7, 96, [&] { ++runs[blockIdx.x * blockDim.x + threadIdx.x]; });
    EXPECT_EQ(runs, std::vector<int>(7 * 96, 1));
}

TEST(OnHost, SeedsChangeTheOrder) {
    std::set<std::vector<unsigned>> orders;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        set_seed(seed);
        std::vector<unsigned> order;
        run_grid(1, 32, [&] { order.push_back(threadIdx.x); });
        orders.insert(order);
        std::vector<unsigned> again;
        set_seed(seed);
        run_grid(1, 32, [&] { again.push_back(threadIdx.x); });
        EXPECT_EQ(order, again);
    }
    EXPECT_EQ(orders.size(), 8u);
}

TEST(OnHost, BarriersShareMemoryBetweenSteps) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        set_seed(seed);
        std::vector<unsigned> sums(3);
        run_grid(3, 256, [&] {
            static unsigned shared[256];
            shared[threadIdx.x] = threadIdx.x + blockIdx.x;
            __syncthreads();
            for (unsigned step = 128; step > 0; step /= 2) {
                if (threadIdx.x < step)
                    shared[threadIdx.x] += shared[threadIdx.x + step];
                __syncthreads();
            }
            if (threadIdx.x == 0)
                sums[blockIdx.x] = shared[0];
        });
        EXPECT_EQ(sums, (std::vector<unsigned>{32640, 32640 + 256, 32640 + 512}));
    }
}

TEST(OnHost, AMissingBarrierIsSeen) {
    std::set<unsigned> sums;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        set_seed(seed);
        run_grid(1, 64, [&] {
            static unsigned shared[64];
            shared[threadIdx.x] = 0;
            __syncthreads();
            shared[threadIdx.x] = 1; // and none here
            if (threadIdx.x == 0)
                sums.insert(std::accumulate(shared, shared + 64, 0u));
        });
    }
    EXPECT_NE(sums, std::set<unsigned>{64});
}

TEST(OnHost, VotesAndShufflesOfAWarp) {
    set_seed(3);
    std::vector<unsigned> votes(64), from_right(64), across(64), up(64), down(64), halves(64);
    run_grid(1, 64, [&] {
        const unsigned i = threadIdx.x, lane = i % 32;
        votes[i] = __ballot_sync(~0u, lane % 3 == 0);
        from_right[i] = __shfl_sync(~0u, i * 10, (lane + 1) % 32);
        across[i] = __shfl_xor_sync(~0u, i, 16);
        up[i] = __shfl_up_sync(~0u, i, 1);
        down[i] = __shfl_down_sync(~0u, i, 1, 16);
        halves[i] = __shfl_sync(~0u, i, 2, 16);
    });
    for (unsigned i = 0; i < 64; ++i) {
        EXPECT_EQ(votes[i], 0x49249249u);
        EXPECT_EQ(from_right[i], (i / 32 * 32 + (i + 1) % 32) * 10);
        EXPECT_EQ(across[i], i ^ 16);
        EXPECT_EQ(up[i], i % 32 ? i - 1 : i);
        EXPECT_EQ(down[i], i % 16 < 15 ? i + 1 : i);
        EXPECT_EQ(halves[i], i / 16 * 16 + 2);
    }
}

TEST(OnHost, LanesOutsideTheMaskGoOn) {
    std::vector<unsigned> votes(32);
    run_grid(1, 32, [&] {
        if (threadIdx.x < 8)
            votes[threadIdx.x] = __ballot_sync(0xff, threadIdx.x != 5);
    });
    for (unsigned i = 0; i < 32; ++i)
        EXPECT_EQ(votes[i], i < 8 ? 0xdfu : 0);
}

TEST(OnHost, AtomicsLoseNothing) {
    unsigned sum = 0, least = 1000, tickets = 0;
    std::set<unsigned> drawn;
    run_grid(4, 128, [&] {
        atomicAdd(&sum, 1u);
        atomicMin(&least, 500 - threadIdx.x);
        drawn.insert(atomicAdd(&tickets, 1u));
    });
    EXPECT_EQ(sum, 512u);
    EXPECT_EQ(least, 500u - 127);
    EXPECT_EQ(drawn.size(), 512u);
}

TEST(OnHost, AReadAndAWriteThatAreNoAtomicLoseSome) {
    unsigned sum = 0;
    set_seed(1);
    run_grid(1, 128, [&] {
        const unsigned old = sum;
        __threadfence();
        sum = old + 1;
    });
    EXPECT_LT(sum, 128u);
}

TEST(OnHost, WhatNoKernelMayDo) {
    EXPECT_THAT(fault_of(32,
                         [] {
                             if (threadIdx.x != 7)
                                 __syncthreads();
                         }),
                HasSubstr("waits at __syncthreads; 1 of 32 threads have ended"));
    EXPECT_THAT(fault_of(32, [] { __ballot_sync(~0u << 1, true); }),
                HasSubstr("lane 0 is not in its own mask"));
    EXPECT_THAT(fault_of(32,
                         [] {
                             if (threadIdx.x < 16)
                                 __ballot_sync(~0u, true);
                             else
                                 __syncwarp();
                         }),
                HasSubstr("waits at another operation"));
    EXPECT_THAT(fault_of(32, [] { __ballot_sync(threadIdx.x < 16 ? 0xffffu : ~0u, true); }),
                HasSubstr("with another mask"));
    EXPECT_THAT(fault_of(16, [] { __syncwarp(); }), HasSubstr("which the block has not"));
    EXPECT_THAT(fault_of(32,
                         [] {
                             if (threadIdx.x < 4)
                                 __shfl_sync(0xf, 1, 9);
                         }),
                HasSubstr("reads lane 9, which is not in the mask"));
    EXPECT_THAT(fault_of(32,
                         [] {
                             if (threadIdx.x > 0)
                                 __syncwarp();
                         }),
                HasSubstr("waits at __syncwarp; 1 of 32"));
    EXPECT_THAT(fault_of(1025, [] {}), HasSubstr("1 to 1024 threads"));
}

TEST(OnHost, WhatIsRecordedIsDoneLater) {
    int done = 0;
    in_turn([&] { ++done; });
    const auto work = record([&] {
        EXPECT_TRUE(is_recording());
        in_turn([&] { done += 10; });
    });
    EXPECT_FALSE(is_recording());
    EXPECT_EQ(done, 1);
    work.at(0)();
    work.at(0)();
    EXPECT_EQ(done, 21);
    EXPECT_THROW(record([] { throw 1; }), int);
    EXPECT_FALSE(is_recording());
}

TEST(OnHost, WhoWritesToWhatWasReleasedIsFound) {
    const Released released;
    auto* const memory = static_cast<std::uint32_t*>(allocate(40));
    memory[9] = 1;
    release(memory);
    released.require_untouched();
    memory[9] = 1;
    EXPECT_THROW(released.require_untouched(), Fault);
}

} // namespace
} // namespace boxwood::on_host
