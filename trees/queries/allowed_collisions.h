#pragma once

#include "trees/queries/filters.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boxwood {

/// An allowed collision matrix: a symmetric set of item pairs whose overlap is expected (links that
/// share a joint, a tool and its holder) and is not to be reported. It starts empty.
/// One bit per unordered pair: n items take n(n-1)/16 bytes. Reading from several threads is safe.
class AllowedCollisions {
  public:
    explicit AllowedCollisions(std::size_t items);

    std::size_t items() const { return items_; }
    std::size_t size() const; ///< number of allowed pairs
    void add_item();          ///< at the end, with no allowed pair

    /// Throw std::invalid_argument if a == b or one of them is not an item.
    void allow(std::uint32_t a, std::uint32_t b) { bits_[checked_slot(a, b)] = true; }
    void disallow(std::uint32_t a, std::uint32_t b) { bits_[checked_slot(a, b)] = false; }

    /// Whether the overlap of a and b, two different items, is allowed; in either order.
    bool allows(std::uint32_t a, std::uint32_t b) const { return bits_[slot(a, b)]; }

  private:
    // The strict lower triangle, row by row: row b starts after the rows of 0, 1, ... b - 1 bits.
    static std::size_t slot(std::size_t a, std::size_t b) {
        return a < b ? b * (b - 1) / 2 + a : a * (a - 1) / 2 + b;
    }
    std::size_t checked_slot(std::uint32_t a, std::uint32_t b) const;

    std::size_t items_;
    std::vector<bool> bits_;
};

/// Allows each link and its neighbour along a chain: (0, 1), (1, 2), ... (n - 2, n - 1).
AllowedCollisions allow_neighbours(std::size_t items);

/// A sink that passes on to `sink` the pairs that are not allowed. Both arguments must outlive it.
inline auto without_allowed(const AllowedCollisions& allowed, PairSink& sink) {
    return FilteredPairs([&allowed](Pair p) { return !allowed.allows(p.a, p.b); }, sink);
}

} // namespace boxwood
