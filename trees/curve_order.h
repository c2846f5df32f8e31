#pragma once

#include "trees/curve_codes.h"
#include "trees/executor.h"

#include <cstdint>

namespace boxwood {

/// The items in the order in which the curve passes their boxes' centres, ties by item index.
struct CurveOrder {
    Buffer<std::uint64_t> codes; ///< 63 bits, ascending
    Buffer<std::uint32_t> order; ///< slot -> item
};

/// The same on every executor and instruction set. Throws as `require_valid`.
CurveOrder curve_order(Boxes boxes, Curve curve, const Executor& executor);

/// A coarse order that other boxes can be put into later: by 10 bits per axis.
struct KeptOrder {
    CurveGrid grid;
    /// In order: the code above the item. Empty if the cells do not tell nearly all items apart.
    Buffer<std::uint64_t> records;
};
KeptOrder kept_curve_order(Boxes boxes, Curve curve, const Executor& executor);

/// Unsorted records of these boxes, numbered from first_item.
void curve_records(Boxes boxes, std::size_t first_item, Curve curve, const CurveGrid& grid,
                   std::uint64_t* records);

/// The order alone, for half the time: by 10 bits per axis where these tell nearly all items apart,
/// else by all 21.
Buffer<std::uint32_t> coarse_curve_order(Boxes boxes, Curve curve, const Executor& executor);

/// One of four groups that boxes may be put into.
using GroupOfBox = std::uint32_t (*)(const Box&);

/// The same for what cuts the order into blocks of sixteen: fewer items than that may be out of
/// order if they are close together. Items of lower groups come first; no function, one group.
Buffer<std::uint32_t> block_curve_order(Boxes boxes, Curve curve, GroupOfBox group,
                                        const Executor& executor);

} // namespace boxwood
