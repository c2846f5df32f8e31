#pragma once

// What is done to whole arrays in the device's memory: primitives.cu with CUB,
// primitives_on_host.cpp where there is no device. `spare` is memory for it, grown if it is too
// small: with what an equal call left there nothing is allocated, and a graph may capture it. No
// call waits.

#include "trees/cuda/launch.h"

namespace boxwood::cuda {

using Spare = Array<std::byte>;

/// Room for n elements, whatever they are then; none moves if there was room.
template <class T> void make_room(Array<T>& in, std::size_t n, Stream stream) {
    if (in.size() >= n)
        return;
    in = {}; // not both at the same time
    in = Array<T>(n, stream);
}

/// Sorts n keys by their bits [low, high), and the values with them; equal ones stay in order.
void sort_by_bits(const std::uint32_t* keys, std::uint32_t* sorted_keys,
                  const std::uint32_t* values, std::uint32_t* sorted_values, std::size_t n, int low,
                  int high, Spare& spare, Stream stream);
void sort_by_bits(const std::uint64_t* keys, std::uint64_t* sorted_keys,
                  const std::uint32_t* values, std::uint32_t* sorted_values, std::size_t n, int low,
                  int high, Spare& spare, Stream stream);

/// Each of n numbers becomes the sum of those before it, and at[n], whatever it was, that of all.
void scan(std::uint32_t* at, std::size_t n, Spare& spare, Stream stream);
void scan(std::uint64_t* at, std::size_t n, Spare& spare, Stream stream);

/// The places of those of n flags that are not 0, ascending; their number goes to *n_to.
void select(const std::uint8_t* flags, std::size_t n, std::uint32_t* to, std::uint32_t* n_to,
            Spare& spare, Stream stream);

} // namespace boxwood::cuda
