#pragma once

// CUDA's thread model without a GPU, so that kernels written for one can be tested by g++ and its
// sanitizers: blocks, warps of 32 lanes, shared memory, barriers, votes, shuffles and atomics.
// Include it through launch.h. Where it is less than a GPU: blocks run one after the other, and a
// thread gives way to others at barriers, warp operations, atomics and fences alone, and sees at
// once what any other wrote. So a fence that is missing is not found here; nor by racecheck on a
// device, which looks at shared memory alone. OnADevice.StressOfManyBuildsAndRefits may, there.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#define __global__ inline
#define __device__
#define __forceinline__ inline
#define __shared__ static
#define __launch_bounds__(...)

namespace boxwood::on_host {

struct Index3 {
    unsigned x = 0, y = 0, z = 0;
};

/// What no correct kernel does: a barrier or warp operation that not all its lanes reach, or that
/// they reach with different masks.
class Fault : public std::logic_error {
    using std::logic_error::logic_error;
};

/// In what order the threads of a block run, and the blocks of a grid: a test sets it.
void set_seed(std::uint64_t seed);

/// Runs `thread` once for each thread of each block. Throws Fault.
void run_grid(unsigned n_blocks, unsigned n_threads, const std::function<void()>& thread);

enum class Meeting : std::uint8_t { block, warp, ballot, shuffle };

/// Waits for all lanes of `mask` (of the whole block for Meeting::block) to come to the same
/// meeting. ballot: the lanes whose value is not 0. shuffle: the value of lane `from`.
std::uint64_t meet(Meeting meeting, unsigned mask, std::uint64_t value = 0, unsigned from = 0);

/// How much of the model's memory is free from now on. To allocate more than is free is a Fault:
/// whoever needs memory has to look first.
void set_free_memory(std::uint64_t bytes);
std::uint64_t free_memory();
void* allocate(std::size_t bytes);
void release(void* memory);

/// Work of a stream: done at once or, within record(), kept.
void in_turn(std::function<void()> work);
/// What `enqueue` does in turn, to be done later and again.
std::vector<std::function<void()>> record(const std::function<void()>& enqueue);
bool is_recording();

/// While one lives, what is released stays as it was filled then.
class Released {
  public:
    Released();
    Released(const Released&) = delete;
    Released& operator=(const Released&) = delete;
    ~Released();
    /// Throws Fault if somebody wrote to memory after it was released.
    void require_untouched() const;
};

/// Lets other threads go first, now and then.
void give_way();

} // namespace boxwood::on_host

// CUDA's own names, as kernels write them.
inline boxwood::on_host::Index3 threadIdx, blockIdx, blockDim, gridDim;
inline constexpr int warpSize = 32;

inline void __syncthreads() { boxwood::on_host::meet(boxwood::on_host::Meeting::block, ~0u); }
inline void __syncwarp(unsigned mask = ~0u) {
    boxwood::on_host::meet(boxwood::on_host::Meeting::warp, mask);
}
inline unsigned __ballot_sync(unsigned mask, bool vote) {
    return static_cast<unsigned>(
        boxwood::on_host::meet(boxwood::on_host::Meeting::ballot, mask, vote));
}
inline bool __any_sync(unsigned mask, bool vote) { return __ballot_sync(mask, vote) != 0; }
inline bool __all_sync(unsigned mask, bool vote) { return __ballot_sync(mask, vote) == mask; }

template <class T> T __shfl_sync(unsigned mask, T value, unsigned from, unsigned width = 32) {
    static_assert(sizeof(T) <= 8);
    const unsigned group = threadIdx.x % 32 / width * width;
    std::uint64_t bits = 0;
    __builtin_memcpy(&bits, &value, sizeof(T));
    bits = boxwood::on_host::meet(boxwood::on_host::Meeting::shuffle, mask, bits,
                                  group + from % width);
    __builtin_memcpy(&value, &bits, sizeof(T));
    return value;
}
/// Beyond the group a lane keeps its own value.
template <class T> T __shfl_xor_sync(unsigned mask, T value, unsigned bits, unsigned width = 32) {
    const unsigned lane = threadIdx.x % 32, from = lane ^ bits;
    return __shfl_sync(mask, value, from / width == lane / width ? from % width : lane % width,
                       width);
}
template <class T> T __shfl_up_sync(unsigned mask, T value, unsigned by, unsigned width = 32) {
    const unsigned lane = threadIdx.x % width;
    return __shfl_sync(mask, value, lane >= by ? lane - by : lane, width);
}
template <class T> T __shfl_down_sync(unsigned mask, T value, unsigned by, unsigned width = 32) {
    const unsigned lane = threadIdx.x % width;
    return __shfl_sync(mask, value, lane + by < width ? lane + by : lane, width);
}

inline int __popc(unsigned x) { return __builtin_popcount(x); }
/// One more than the place of the lowest set bit; 0 if there is none.
inline int __ffs(int x) { return __builtin_ffs(x); }

/// Of any type, as on a device.
template <class T> T __ldcg(const T* at) {
    T value;
    __builtin_memcpy(&value, at, sizeof value);
    return value;
}
inline void __threadfence() { boxwood::on_host::give_way(); }

/// The old value, as all atomics give.
template <class T, class Change> T boxwood_atomic(T* at, Change change) {
    boxwood::on_host::give_way();
    const T old = *at;
    *at = change(old);
    return old;
}
template <class T> T atomicAdd(T* at, T value) {
    return boxwood_atomic(at, [=](T old) { return static_cast<T>(old + value); });
}
template <class T> T atomicMin(T* at, T value) {
    return boxwood_atomic(at, [=](T old) { return value < old ? value : old; });
}
template <class T> T atomicMax(T* at, T value) {
    return boxwood_atomic(at, [=](T old) { return value > old ? value : old; });
}
template <class T> T atomicOr(T* at, T value) {
    return boxwood_atomic(at, [=](T old) { return old | value; });
}
template <class T> T atomicExch(T* at, T value) {
    return boxwood_atomic(at, [=](T) { return value; });
}
template <class T> T atomicCAS(T* at, T expected, T value) {
    return boxwood_atomic(at, [=](T old) { return old == expected ? value : old; });
}
