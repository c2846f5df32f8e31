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

inline Centres no_centres() {
    const float inf = std::numeric_limits<float>::infinity();
    return {{ordered(inf), ordered(inf), ordered(inf)},
            {ordered(-inf), ordered(-inf), ordered(-inf)},
            none_bad};
}

constexpr unsigned code_threads = 256;

/// A thread per box; *to is no_centres() at first.
__global__ void measure_centres(const Box* boxes, std::uint32_t n, Centres* to) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    Centres all;
    for (int axis = 0; axis < 3; ++axis) {
        all.low[axis] = 0x7fffffff;
        all.high[axis] = -0x7fffffff - 1;
    }
    all.first_bad = none_bad;
    if (i < n) {
        const Box box = boxes[i];
        for (int axis = 0; axis < 3; ++axis) {
            const float low = box.min[axis], high = box.max[axis];
            if (!(low - low == 0 && high - high == 0 && low <= high))
                all.first_bad = i;
            all.low[axis] = all.high[axis] = ordered(.5f * low + .5f * high);
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

/// A thread per box: the code by 10 or by 21 bits per axis, and the box's number to be sorted with.
template <int bits, class Code>
__global__ void curve_codes(const Box* boxes, std::uint32_t n, Curve curve, CurveGrid grid,
                            Code* codes, std::uint32_t* items) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) {
        codes[i] = static_cast<Code>(curve_code<bits>(boxes[i], curve, grid));
        items[i] = i;
    }
}

} // namespace boxwood::cuda
