#pragma once

#include "trees/tree.h"

#include <cstdint>

namespace boxwood {

/// A space-filling curve through the cube around the centres of the boxes, 21 bits per axis.
enum class Curve : std::uint8_t {
    morton, ///< bits of the axes in turn: cheap, and what binary radix trees split by
    hilbert ///< no jumps: neighbours on the curve are neighbours in space
};

/// The cube around the centres of some boxes and its cells; centres elsewhere belong to the cells
/// next to them.
struct CurveGrid {
    Vec3<float> low; ///< of the cube, times `power`
    float power = 1; ///< of two: takes huge and tiny coordinates to where nothing overflows
    float scale = 0; ///< from there to cells
};

/// Bounds of the centres of some boxes, and whether all of the boxes are valid.
struct CentreBounds {
    Box box;
    bool valid = true;
};
CentreBounds measure_centres(Boxes boxes);

/// Where the curve passes the cells of the boxes' centres, the same on every instruction set: by 21
/// bits per axis, and by 10 in a grid of as many.
/// Source of the Hilbert curve: Skilling 2004, "Programming the Hilbert curve".
void fine_codes(Boxes boxes, Curve curve, const CurveGrid& grid, std::uint64_t* codes);
void coarse_codes(Boxes boxes, Curve curve, const CurveGrid& grid, std::uint32_t* codes);

} // namespace boxwood
