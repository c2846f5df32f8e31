#include "bench/machine/caches.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

constexpr std::uint64_t min_last_level = std::uint64_t{16} << 20; ///< where none is known
constexpr std::size_t words_per_line = 8;

std::uint64_t last_level_bytes(const Machine& machine) {
    return std::max({machine.l3_bytes.value_or(0), machine.l2_bytes.value_or(0), min_last_level});
}

} // namespace

CacheFlush::CacheFlush(const Machine& machine)
    : memory_(2 * last_level_bytes(machine) / sizeof(std::uint64_t)) {}

double CacheFlush::guessed_s(const Machine& machine) {
    constexpr double bytes_per_s = 4e9;
    return 2 * static_cast<double>(last_level_bytes(machine)) / bytes_per_s;
}

void CacheFlush::operator()() {
    std::uint64_t carried = 1;
    for (std::size_t i = 0; i < memory_.size(); i += words_per_line)
        carried = memory_[i] += carried; // no line is left out
}

} // namespace boxwood::bench
