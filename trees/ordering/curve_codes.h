#pragma once

#include "kernels/arithmetic/on_both.h"
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

/// The cube around the centres, cut into 2^bits cells along each axis.
BOXWOOD_BOTH inline CurveGrid curve_grid(const Box& centres, int bits) {
    const Vec3<double> extent =
        static_cast<Vec3<double>>(centres.max) - static_cast<Vec3<double>>(centres.min);
    const double xy = extent.x < extent.y ? extent.y : extent.x;
    const double side = xy < extent.z ? extent.z : xy;
    CurveGrid grid;
    if (!(side > 0))
        return grid;
    // A side below 2^-60 has all coordinates below 2^-36 (else the centres would be the same).
    grid.power = side > 0x1p100 ? 0x1p-30f : side < 0x1p-60 ? 0x1p80f : 1.f;
    grid.low = grid.power * centres.min;
    grid.scale = static_cast<float>(static_cast<double>(1u << bits) /
                                    (side * static_cast<double>(grid.power)));
    return grid;
}

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
