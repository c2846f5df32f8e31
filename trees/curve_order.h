#pragma once

#include "trees/executor.h"
#include "trees/tree.h"

#include <cstdint>

namespace boxwood {

/// A space-filling curve through the cube around the centres of the boxes, 21 bits per axis.
enum class Curve : std::uint8_t {
    morton, ///< bits of the axes in turn: cheap, and what binary radix trees split by
    hilbert ///< no jumps: neighbours on the curve are neighbours in space
};

/// The items in the order in which the curve passes their boxes' centres, ties by item index.
struct CurveOrder {
    Buffer<std::uint64_t> codes; ///< 63 bits, ascending
    Buffer<std::uint32_t> order; ///< slot -> item
};

/// The same on every executor and instruction set. Throws as `require_valid`.
/// Source of the Hilbert curve: Skilling 2004, "Programming the Hilbert curve".
CurveOrder curve_order(Boxes boxes, Curve curve, const Executor& executor);

/// The cube around the centres of some boxes and its cells; centres elsewhere belong to the cells
/// next to them.
struct CurveGrid {
    Vec3<float> low; ///< of the cube, times `power`
    float power = 1; ///< of two: takes huge and tiny coordinates to where nothing overflows
    float scale = 0; ///< from there to cells
};

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

} // namespace boxwood
