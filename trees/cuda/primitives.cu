#include "trees/cuda/primitives.h"

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>
#include <thrust/iterator/counting_iterator.h>

namespace boxwood::cuda {
namespace {

/// call(memory, bytes, stream): first how many bytes it needs, then what it does.
template <class Call> void with_memory(Spare& spare, Stream stream, const Call& call) {
    std::size_t bytes = 0;
    require(call(nullptr, bytes), "how much memory a primitive needs");
    make_room(spare, bytes > 0 ? bytes : 1, stream); // null would ask again
    require(call(spare.data(), bytes), "a primitive does not start");
}

template <class Key>
void sort(const Key* keys, Key* sorted_keys, const std::uint32_t* values,
          std::uint32_t* sorted_values, std::size_t n, int low, int high, Spare& spare,
          Stream stream) {
    with_memory(spare, stream, [&](void* memory, std::size_t& bytes) {
        return cub::DeviceRadixSort::SortPairs(memory, bytes, keys, sorted_keys, values,
                                               sorted_values, static_cast<std::uint32_t>(n), low,
                                               high, stream.handle);
    });
}

template <class Number> void sum(Number* at, std::size_t n, Spare& spare, Stream stream) {
    with_memory(spare, stream, [&](void* memory, std::size_t& bytes) {
        return cub::DeviceScan::ExclusiveSum(memory, bytes, at, at,
                                             static_cast<std::uint32_t>(n + 1), stream.handle);
    });
}

} // namespace

void sort_by_bits(const std::uint32_t* keys, std::uint32_t* sorted_keys,
                  const std::uint32_t* values, std::uint32_t* sorted_values, std::size_t n, int low,
                  int high, Spare& spare, Stream stream) {
    sort(keys, sorted_keys, values, sorted_values, n, low, high, spare, stream);
}
void sort_by_bits(const std::uint64_t* keys, std::uint64_t* sorted_keys,
                  const std::uint32_t* values, std::uint32_t* sorted_values, std::size_t n, int low,
                  int high, Spare& spare, Stream stream) {
    sort(keys, sorted_keys, values, sorted_values, n, low, high, spare, stream);
}

void scan(std::uint32_t* at, std::size_t n, Spare& spare, Stream stream) {
    sum(at, n, spare, stream);
}
void scan(std::uint64_t* at, std::size_t n, Spare& spare, Stream stream) {
    sum(at, n, spare, stream);
}

void select(const std::uint8_t* flags, std::size_t n, std::uint32_t* to, std::uint32_t* n_to,
            Spare& spare, Stream stream) {
    with_memory(spare, stream, [&](void* memory, std::size_t& bytes) {
        return cub::DeviceSelect::Flagged(memory, bytes,
                                          thrust::counting_iterator<std::uint32_t>(0), flags, to,
                                          n_to, static_cast<std::uint32_t>(n), stream.handle);
    });
}

} // namespace boxwood::cuda
