#pragma once

#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boxwood::bench {

/// One query of each of m equal runs of n, picked by a hash of the scene's seed.
inline std::vector<std::size_t> sampled_queries(std::size_t n, std::size_t m, std::uint64_t seed) {
    std::vector<std::size_t> sample;
    for (std::size_t k = 0; k < m; ++k) {
        const std::size_t first = k * n / m, last = (k + 1) * n / m;
        sample.push_back(first + XXH3_64bits_withSeed(&k, sizeof k, seed) % (last - first));
    }
    return sample;
}

} // namespace boxwood::bench
