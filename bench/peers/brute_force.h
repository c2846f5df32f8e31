#pragma once

#include "kernels/primitives/aabb.h"
#include "trees/queries/sinks.h"

#include <array>
#include <span>
#include <vector>

namespace boxwood::bench {

/// Boxes as six arrays of floats, tested one against a run of others with Highway's widest vectors.
/// It has no structure at all, which is why it can be the oracle for those that have one.
class BruteForce {
  public:
    /// Columns that stay in the first-level cache (24 KiB) while all rows pass over them.
    static constexpr std::size_t tile = 1024;

    explicit BruteForce(std::span<const Aabb<float>> boxes);

    std::size_t size() const { return size_; }

    /// Appends (row, column) for each column of [begin, end) whose box overlaps that of `row`.
    void append_row(std::size_t row, std::size_t begin, std::size_t end,
                    std::vector<Pair>& out) const;

    /// Appends every overlapping (i, j) with i < min(j, row_end) and j of [begin, end).
    void append_columns(std::size_t begin, std::size_t end, std::size_t row_end,
                        std::vector<Pair>& out) const;

  private:
    std::size_t size_ = 0, stride_ = 0;
    std::vector<float> bounds_; ///< min x, y, z, max x, y, z: `stride_` numbers each
};

} // namespace boxwood::bench
