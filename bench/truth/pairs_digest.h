#pragma once

#include "trees/queries/sinks.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What a list of pairs comes to, whatever its order: two lists with one digest hold the same pairs
/// equally often, but for a chance of about 2^-64.
struct PairsDigest {
    std::uint64_t count = 0, hash = 0;

    void add(Pair p) {
        std::uint64_t x = (std::uint64_t{p.a} << 32 | p.b) + 0x9e3779b97f4a7c15u;
        x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u; // splitmix64
        x = (x ^ x >> 27) * 0x94d049bb133111ebu;
        hash += x ^ x >> 31;
        ++count;
    }
    void add(const PairsDigest& other) {
        count += other.count;
        hash += other.hash;
    }
    bool operator==(const PairsDigest&) const = default;
};
PairsDigest digest_of(std::span<const Pair> pairs);

/// The pairs of all parts, ascending.
std::vector<Pair> sorted_pairs(std::vector<std::vector<Pair>> parts);

/// What is wrong with an answer, each pair that is there twice extra once.
struct PairsDifference {
    std::size_t missing = 0, extra = 0;
    std::string witness; ///< "missing (3,7)", or "extra (3,7)" if none is missing
};
/// expected: ascending.
PairsDifference difference(std::span<const Pair> expected, std::vector<Pair> got);

} // namespace boxwood::bench
