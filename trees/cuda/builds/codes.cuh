#pragma once

#include "trees/cuda/launch.h"
#include "trees/ordering/curve_codes.h"

namespace boxwood::cuda {

/// What measure_centres gives, found side by side; `first_bad` is the first box that is not valid.
struct Centres {
    int low[3], high[3]; ///< as integers that compare as the floats do
    std::uint32_t first_bad;
};

/// Integers of the same order as the floats; +0 is above -0.
BOXWOOD_BOTH inline int ordered(float x) {
    const int bits = bits_as<int>(x);
    return bits >= 0 ? bits : bits ^ 0x7fffffff;
}
BOXWOOD_BOTH inline float from_ordered(int x) {
    return bits_as<float>(x >= 0 ? x : x ^ 0x7fffffff);
}

constexpr std::uint32_t none_bad = 0xffffffff;

BOXWOOD_BOTH inline Centres no_centres() {
    const int high = ordered(Box::inf), low = ordered(-Box::inf);
    return {{high, high, high}, {low, low, low}, none_bad};
}

constexpr unsigned code_threads = 256, max_measure_blocks = 2048;

/// *to is no_centres() at first. Any number of blocks: each thread takes every so-manyeth box.
__global__ void measure_centres(const Box* boxes, std::uint32_t n, Centres* to) {
    Centres all = no_centres();
    for (std::uint64_t i = std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x; i < n;
         i += std::uint64_t{gridDim.x} * blockDim.x) {
        const Box box = boxes[i];
        for (int axis = 0; axis < 3; ++axis) {
            const float low = box.min[axis], high = box.max[axis];
            if (!(low - low == 0 && high - high == 0 && low <= high))
                all.first_bad = i < all.first_bad ? static_cast<std::uint32_t>(i) : all.first_bad;
            const int centre = ordered(.5f * low + .5f * high);
            all.low[axis] = centre < all.low[axis] ? centre : all.low[axis];
            all.high[axis] = centre > all.high[axis] ? centre : all.high[axis];
        }
    }
    for (unsigned step = 16; step > 0; step /= 2) {
        for (int axis = 0; axis < 3; ++axis) {
            const int low = __shfl_xor_sync(~0u, all.low[axis], step),
                      high = __shfl_xor_sync(~0u, all.high[axis], step);
            all.low[axis] = low < all.low[axis] ? low : all.low[axis];
            all.high[axis] = high > all.high[axis] ? high : all.high[axis];
        }
        const std::uint32_t bad = __shfl_xor_sync(~0u, all.first_bad, step);
        all.first_bad = bad < all.first_bad ? bad : all.first_bad;
    }
    if (threadIdx.x % 32 != 0)
        return;
    for (int axis = 0; axis < 3; ++axis) {
        atomicMin(&to->low[axis], all.low[axis]);
        atomicMax(&to->high[axis], all.high[axis]);
    }
    if (all.first_bad != none_bad)
        atomicMin(&to->first_bad, all.first_bad);
}

/// Cells to the transposed Hilbert index (Skilling 2004), as fine_codes of the CPU has it.
template <int bits>
BOXWOOD_BOTH void hilbert_index(std::uint32_t& x, std::uint32_t& y, std::uint32_t& z) {
    for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
        const std::uint32_t below = q - 1;
        const auto turn = [&](std::uint32_t& axis) {
            if (axis & q) {
                x ^= below;
            } else {
                const std::uint32_t swapped = (x ^ axis) & below;
                x ^= swapped;
                axis ^= swapped;
            }
        };
        if (x & q)
            x ^= below;
        turn(y);
        turn(z);
    }
    y ^= x;
    z ^= y;
    std::uint32_t t = z >> 1; // each bit the parity of the bits of z above it
    for (int by = 1; by < bits; by *= 2)
        t ^= t >> by;
    x ^= t;
    y ^= t;
    z ^= t;
}

/// Two zeros before each of 21 bits.
BOXWOOD_BOTH inline std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

/// The cell of a centre on one axis of a grid of 2^bits cells; 10 bits as coarse_codes has them.
template <int bits>
BOXWOOD_BOTH std::uint32_t cell_of(float min, float max, float low, const CurveGrid& grid) {
    const float half = .5f * grid.power;
    const float at = (min * half + max * half - low) * grid.scale;
    if constexpr (bits == 10) {
        // Numbers from 1024 to below 2048 have the cell as the leading bits of their mantissa.
        const float moved = at + 1024;
        const float kept = moved < 1024 ? 1024 : moved < 2047.5f ? moved : 2047.5f;
        return bits_as<std::uint32_t>(kept) >> 13 & 1023;
    } else {
        constexpr float last = (1 << bits) - 1;
        return static_cast<std::uint32_t>(at < 0 ? 0 : at < last ? at : last);
    }
}

/// Where the curve passes the centre, by `bits` bits per axis.
template <int bits>
BOXWOOD_BOTH std::uint64_t curve_code(const Box& box, Curve curve, const CurveGrid& grid) {
    std::uint32_t x = cell_of<bits>(box.min.x, box.max.x, grid.low.x, grid),
                  y = cell_of<bits>(box.min.y, box.max.y, grid.low.y, grid),
                  z = cell_of<bits>(box.min.z, box.max.z, grid.low.z, grid);
    if (curve == Curve::hilbert)
        hilbert_index<bits>(x, y, z);
    return spread(x) << 2 | spread(y) << 1 | spread(z);
}

/// What the codes of some boxes are made by.
struct CodeRule {
    CurveGrid grid;
    bool apart; ///< the long boxes of each axis
};

/// Half of the extents, which cannot overflow.
BOXWOOD_BOTH inline Vec3<float> half_extent(const Box& box) {
    return .5f * box.max - .5f * box.min;
}
/// As HilbertBuilder::groups: the axis along which a box is longest, of equal ones the first.
BOXWOOD_BOTH inline std::uint32_t longest_axis(const Box& box) {
    const Vec3<float> e = half_extent(box);
    if (e.z > (e.x < e.y ? e.y : e.x))
        return 2;
    return e.y > e.x ? 1 : 0;
}

/// One block: the rule for boxes with these centres, by a sample of at most 1024 of them as
/// HilbertBuilder::groups has it. may_part: long boxes may come apart.
template <int bits>
__global__ void make_code_rule(const Box* boxes, std::uint32_t n, const Centres* centres,
                               bool may_part, CodeRule* to) {
    __shared__ double middles[code_threads], longests[code_threads];
    const std::uint32_t step = n / 1024 + 1;
    double middle = 0, longest = 0;
    for (std::uint64_t i = std::uint64_t{threadIdx.x} * step; may_part && i < n;
         i += std::uint64_t{code_threads} * step) {
        const Vec3<float> e = half_extent(boxes[i]);
        const float low = e.x < e.y ? e.x : e.y, high = e.x < e.y ? e.y : e.x;
        const float below = e.z < high ? e.z : high;
        middle += static_cast<double>(low < below ? below : low);
        longest += static_cast<double>(high < e.z ? e.z : high);
    }
    middles[threadIdx.x] = middle;
    longests[threadIdx.x] = longest;
    for (unsigned half = code_threads / 2; half > 0; half /= 2) {
        __syncthreads();
        if (threadIdx.x < half) {
            middles[threadIdx.x] += middles[threadIdx.x + half];
            longests[threadIdx.x] += longests[threadIdx.x + half];
        }
    }
    if (threadIdx.x != 0)
        return;
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = from_ordered(centres->low[axis]);
        box.max[axis] = from_ordered(centres->high[axis]);
    }
    *to = {curve_grid(box, bits), longests[0] > 3 * middles[0]};
}

/// A thread per box: the code by 10 or by 21 bits per axis with the group, if they come apart,
/// above it (for the room of which the finest bit goes), and the box's number to be sorted with.
template <int bits, class Code>
__global__ void curve_codes(const Box* boxes, std::uint32_t n, Curve curve, const CodeRule* rule,
                            Code* codes, std::uint32_t* items) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n)
        return;
    constexpr int top = sizeof(Code) * 8 - 2;
    const Box box = boxes[i];
    Code code = static_cast<Code>(curve_code<bits>(box, curve, rule->grid));
    if (rule->apart)
        code = code >> (3 * bits > top ? 3 * bits - top : 0) | static_cast<Code>(longest_axis(box))
                                                                   << top;
    codes[i] = code;
    items[i] = i;
}

/// A thread per box. *crowded, 0 at first, becomes the number of codes with eight equal ones before
/// them: of many of these the order is worth little.
template <class Code>
__global__ void count_crowded(const Code* sorted, std::uint32_t n, std::uint32_t* crowded) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    const unsigned votes = __ballot_sync(~0u, i >= 8 && i < n && sorted[i - 8] == sorted[i]);
    if (votes != 0 && threadIdx.x % 32 == 0)
        atomicAdd(crowded, static_cast<std::uint32_t>(__popc(votes)));
}

} // namespace boxwood::cuda
