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

/// The order alone, for half the time: by 10 bits per axis where these tell nearly all items apart,
/// else by all 21.
Buffer<std::uint32_t> coarse_curve_order(Boxes boxes, Curve curve, const Executor& executor);

} // namespace boxwood
