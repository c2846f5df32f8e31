#pragma once

#include "trees/cuda/launch.h"
#include "trees/queries/sinks.h"

namespace boxwood::cuda {

/// What a pass over the pairs does with them. The first two together give each leaf of `a` its own
/// place, so that the order is the same each time.
enum class Pass : std::uint8_t {
    count, ///< at[leaf] becomes the number of pairs of that leaf of `a`
    fill,  ///< those of a leaf go to pairs[at[leaf]] and on
    capped ///< in any order; at[0] counts them all, those beyond `room` are left out
};

struct PairsTo {
    std::uint64_t* at;
    Pair* pairs;
    std::uint64_t room; ///< of pairs; of Pass::capped alone

    /// The first of n places of Pass::capped.
    __device__ std::uint64_t take(unsigned n) const {
        return atomicAdd(reinterpret_cast<unsigned long long*>(at), // the same, by another name
                         static_cast<unsigned long long>(n));
    }
};

template <bool is_self> __device__ Pair pair_of(std::uint32_t x, std::uint32_t y) {
    return is_self && y < x ? Pair{y, x} : Pair{x, y};
}

} // namespace boxwood::cuda
