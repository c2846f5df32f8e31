#pragma once

#include "trees/layout.h"

namespace boxwood {

class BinaryLayout;
class Wide8Layout;

/// hits[i] answers rays[i]. `kernel` is the word of a ray-triangle kernel; an unknown one throws
/// std::invalid_argument. Triangles are tested in the slot order of the layout's tree.
/// closest: the least t, ties to the lowest triangle; any: some hit if there is one.
void rays(const BinaryLayout& tree, std::span<const Ray<float>> rays, RayQuery query,
          std::string_view kernel, const OrderedTriangles& triangles, const Executor& executor,
          std::span<RayHit> hits);
void rays(const Wide8Layout& tree, std::span<const Ray<float>> rays, RayQuery query,
          std::string_view kernel, const OrderedTriangles& triangles, const Executor& executor,
          std::span<RayHit> hits);

/// The same on one thread, with the work counted.
Work rays_counted(const BinaryLayout& tree, std::span<const Ray<float>> rays, RayQuery query,
                  std::string_view kernel, const OrderedTriangles& triangles,
                  std::span<RayHit> hits);
Work rays_counted(const Wide8Layout& tree, std::span<const Ray<float>> rays, RayQuery query,
                  std::string_view kernel, const OrderedTriangles& triangles,
                  std::span<RayHit> hits);

} // namespace boxwood
