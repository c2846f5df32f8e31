#include "trees/cuda/primitives.h"

#include <numeric>

namespace boxwood::cuda {
namespace {

/// By eight bits at a time; `from_keys` has room for the keys, and for the values behind them.
template <class Key>
void sort_in(Key* from_keys, const Key* keys, Key* sorted_keys, const std::uint32_t* values,
             std::uint32_t* sorted_values, std::size_t n, int low, int high) {
    std::copy_n(keys, n, sorted_keys);
    std::copy_n(values, n, sorted_values);
    auto* const from_values = reinterpret_cast<std::uint32_t*>(from_keys + n);
    for (; low < high; low += 8) {
        const Key mask = (Key{1} << std::min(high - low, 8)) - 1;
        std::copy_n(sorted_keys, n, from_keys);
        std::copy_n(sorted_values, n, from_values);
        std::size_t at[257] = {};
        for (std::size_t i = 0; i < n; ++i)
            ++at[(from_keys[i] >> low & mask) + 1];
        std::partial_sum(at, at + 257, at);
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t to = at[from_keys[i] >> low & mask]++;
            sorted_keys[to] = from_keys[i];
            sorted_values[to] = from_values[i];
        }
    }
}

template <class Key>
void sort(const Key* keys, Key* sorted_keys, const std::uint32_t* values,
          std::uint32_t* sorted_values, std::size_t n, int low, int high, Spare& spare,
          Stream stream) {
    make_room(spare, n * (sizeof(Key) + sizeof(std::uint32_t)), stream);
    on_host::in_turn([=, room = reinterpret_cast<Key*>(spare.data())] {
        sort_in(room, keys, sorted_keys, values, sorted_values, n, low, high);
    });
}

template <class Number> void sum(Number* at, std::size_t n) {
    on_host::in_turn([=] {
        at[n] = 0;
        std::exclusive_scan(at, at + n + 1, at, Number{0});
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

void scan(std::uint32_t* at, std::size_t n, Spare&, Stream) { sum(at, n); }
void scan(std::uint64_t* at, std::size_t n, Spare&, Stream) { sum(at, n); }

void select(const std::uint8_t* flags, std::size_t n, std::uint32_t* to, std::uint32_t* n_to,
            Spare&, Stream) {
    on_host::in_turn([=] {
        *n_to = 0;
        for (std::size_t i = 0; i < n; ++i)
            if (flags[i] != 0)
                to[(*n_to)++] = static_cast<std::uint32_t>(i);
    });
}

} // namespace boxwood::cuda
