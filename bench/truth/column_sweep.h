#pragma once

#include "bench/truth/pairs_digest.h"
#include "kernels/primitives/aabb.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// Every unordered pair of overlapping boxes, by an oracle that uses no tree: the y-z plane is cut
/// into columns, each box is listed in every column that it reaches, and the boxes of a column,
/// sorted by their least x, meet those that begin before they end. A pair is reported in the column
/// of the lower corner of its overlap alone. A box that is none (empty, or with NaN) is left out.
class ColumnSweep {
  public:
    /// The boxes must outlive it. `threads` may be used.
    ColumnSweep(std::span<const Aabb<float>> boxes, unsigned threads);

    /// Number and hash of the pairs, of which no list is held; without those of which is_left_out.
    PairsDigest digest(const std::function<bool(Pair)>& is_left_out = {}) const;
    /// Ascending.
    std::vector<Pair> pairs() const;

  private:
    template <class Take> void for_each_column(const Take& take) const;
    std::uint32_t column_of(float at, int axis) const;
    void cut(double max_entries);
    void list();

    std::span<const Aabb<float>> boxes_;
    unsigned threads_;
    // Of y and z: how a coordinate becomes the number of a column.
    double low_[2]{}, per_unit_[2]{};
    std::uint32_t count_[2]{1, 1};
    std::vector<std::size_t> first_;     ///< by column: where its entries begin, and the end of all
    std::vector<std::uint32_t> entries_; ///< boxes, column by column
};

} // namespace boxwood::bench
