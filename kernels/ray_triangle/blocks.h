#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/ray_triangle/triangle_block.h"

#include <span>
#include <string_view>

namespace boxwood {

/// One ray against a block of 4 or 8 triangles, many times: hits[i] is the nearest hit of rays[i]
/// in blocks[i], ties to the lowest id, bit for bit as one triangle after the other. By SIMD where
/// the kernel has such a test (moller_trumbore_f32 and _f64, watertight). All spans are of one
/// size. False, and nothing done, if `kernel` is no name of ray_kernels().
bool nearest_in_blocks(std::string_view kernel, std::span<const Ray<float>> rays,
                       std::span<const TriangleBlock<4>> blocks, std::span<RayHit> hits);
bool nearest_in_blocks(std::string_view kernel, std::span<const Ray<float>> rays,
                       std::span<const TriangleBlock<8>> blocks, std::span<RayHit> hits);

} // namespace boxwood
