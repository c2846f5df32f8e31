#pragma once

#include "kernels/primitives/vec3.h"

#include <cstddef>
#include <cstdint>

namespace boxwood::detail {

/// A box in any pose around what is below a block: the points x with |axis_k . (x - centre)| <=
/// half_k, k = 0, 1, 2. The axes are orthonormal but for the rounding of each component to float.
struct PosedBox {
    double centre[3];
    float axis[3][3]; ///< by axis, then component
    float half[3];
    /// How far the box may reach along a unit vector n beyond sum |n . axis_k| half_k, as the axes
    /// are not quite orthonormal; 0 if they are the coordinate axes.
    float slack;
    /// At least |centre - lane's centre|_1 + sum of the lane's half_k, for each lane of the block,
    /// and the sum of the block's own.
    float reach;
};

/// Eight boxes in any pose side by side. The floats are for bounds that allow for their rounding;
/// `centre_f64` and `slack`, touched rarely, are for those that must tell ties apart.
struct alignas(64) ObbBlock {
    static constexpr std::uint32_t width = 8;

    float centre[3][width]; ///< from own.centre, rounded
    float axis[3][3][width];
    float half[3][width];
    std::uint32_t ref[width];
    PosedBox own;
    std::uint32_t count; ///< lanes in use, from lane 0; the others hold zeros
    float slack[width];
    double centre_f64[3][width];
};
static_assert(sizeof(ObbBlock) == 832);

/// Up to eight triangles side by side: rows of their corners, in the mesh's frame.
struct alignas(64) TriangleLeaf {
    static constexpr std::uint32_t width = 8;

    float corner[3][3][width]; ///< by corner, axis and lane; unused lanes repeat lane 0
    std::uint32_t triangle[width];
    PosedBox own;
    std::uint32_t count;

    Vec3<double> corner_f64(std::size_t k, std::size_t lane) const {
        return {double{corner[k][0][lane]}, double{corner[k][1][lane]}, double{corner[k][2][lane]}};
    }
};

/// References: the index of a block, or with the top bit that of a leaf.
inline constexpr std::uint32_t leaf_bit = 0x80000000u;
constexpr bool is_leaf(std::uint32_t ref) { return (ref & leaf_bit) != 0; }
constexpr std::uint32_t index_of(std::uint32_t ref) { return ref & ~leaf_bit; }

} // namespace boxwood::detail
