#pragma once

#include "trees/layout.h"

namespace boxwood {

/// Answers the rays of a picture as layout.rays does, bit for bit. They are given row by row,
/// `width` in a row, of which the last may be shorter; they are traced tile by tile, 4 x 4 pixels
/// each, as such rays visit much the same nodes (traversals/rays/coherent_rays.h). Who makes rays
/// in that order has no need of this. Throws std::invalid_argument for a width of 0, and as
/// layout.rays.
void tiled_rays(const AnyLayout& layout, std::span<const Ray<float>> rays, std::size_t width,
                RayQuery query, std::string_view kernel, const TriangleBlocks& triangles,
                const Executor& executor, std::span<RayHit> hits);

} // namespace boxwood
