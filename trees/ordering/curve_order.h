#pragma once

#include "trees/executor.h"
#include "trees/ordering/curve_codes.h"

#include <cstdint>

namespace boxwood {

/// The items in the order in which the curve passes their boxes' centres, ties by item index.
struct CurveOrder {
    Buffer<std::uint64_t> codes; ///< 63 bits, ascending
    Buffer<std::uint32_t> order; ///< slot -> item
};

/// The same on every executor and instruction set. Throws as `require_valid`.
CurveOrder curve_order(Boxes boxes, Curve curve, const Executor& executor);

// Where `centres` are given, these are the bounds of the boxes' centres, and the boxes are known to
// be valid.

/// One of three groups that boxes may be put into: items of lower groups come first.
using GroupOfBox = std::uint32_t (*)(const Box&);

/// A coarse order that other boxes can be put into later: by 10 bits per axis.
struct MergeableOrder {
    CurveGrid grid;
    GroupOfBox group = nullptr; ///< no function, one group
    /// In order: the code above the item. Empty if the cells do not tell nearly all items apart.
    Buffer<std::uint64_t> records;
};
MergeableOrder mergeable_curve_order(Boxes boxes, Curve curve, GroupOfBox group,
                                     const Executor& executor, const Box* centres = nullptr);

/// Unsorted records of these boxes, numbered from 0: of 64 bits, the item in the lower 32.
void curve_records(Boxes boxes, Curve curve, const CurveGrid& grid, GroupOfBox group,
                   std::uint64_t* records);

/// The order alone, for half the time: by 10 bits per axis; where many items are in one cell, by 10
/// bits per axis within the bounds of their centres, and so on.
Buffer<std::uint32_t> coarse_curve_order(Boxes boxes, Curve curve, const Executor& executor);

/// The same for what cuts the order into blocks of sixteen: fewer items than that may be out of
/// order if they are close together.
Buffer<std::uint32_t> block_curve_order(Boxes boxes, Curve curve, GroupOfBox group,
                                        const Executor& executor, const Box* centres = nullptr);

} // namespace boxwood
