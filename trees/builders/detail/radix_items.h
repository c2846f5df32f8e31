#pragma once

#include <cstddef>
#include <cstdint>

namespace boxwood::detail {

/// A subtree: its node, and the slots [begin, end) of its items.
struct RadixPart {
    std::uint32_t node, begin, end;
    std::uint32_t count() const { return end - begin; }
};

/// Items by slot, sorted by codes and distinguished by their numbers where these are equal: a code
/// above an item in each record.
struct CoarseItems {
    const std::uint64_t* records;

    std::uint32_t item(std::size_t i) const { return static_cast<std::uint32_t>(records[i]); }
    /// The bits in which slots differ: how high in the tree they separate, by the first of these.
    std::uint64_t differing(std::size_t i, std::size_t j) const { return records[i] ^ records[j]; }
    /// Between two neighbours' keys within one subtree the greater has the higher bit, so they are
    /// compared as they are.
    std::uint64_t parting(std::size_t i) const { return differing(i - 1, i); }
    bool has(std::size_t i, std::uint64_t bit) const { return (records[i] & bit) != 0; }
};

/// The same with codes that fill a word: below their bits come those of the slots.
struct FineItems {
    const std::uint64_t* codes;
    const std::uint32_t* order;

    std::uint32_t item(std::size_t i) const { return order[i]; }
    std::uint64_t differing(std::size_t i, std::size_t j) const { return codes[i] ^ codes[j]; }
    std::uint64_t parting(std::size_t i) const {
        const std::uint64_t bits = differing(i - 1, i);
        return bits ? bits + (std::uint64_t{1} << 32) : (i - 1) ^ i;
    }
    bool has(std::size_t i, std::uint64_t bit) const { return (codes[i] & bit) != 0; }
};

} // namespace boxwood::detail
