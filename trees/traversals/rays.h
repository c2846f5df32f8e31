#pragma once

#include "trees/layouts/binary.h"
#include "trees/layouts/wide.h"

#include <stdexcept>

namespace boxwood {

/// The triangles of the mesh whose triangle boxes the layout was built from, as its walk wants
/// them.
TriangleBlocks triangles_of(const BinaryLayout& tree, const TriangleMesh& mesh);
TriangleBlocks triangles_of(const Wide8Layout& tree, const TriangleMesh& mesh);

/// hits[i] answers rays[i]. `kernel` is the word of a ray-triangle kernel; an unknown one throws
/// std::invalid_argument. `triangles` are `triangles_of` the same layout.
/// closest: the least t, ties to the lowest triangle; any: some hit if there is one.
void rays(const BinaryLayout& tree, std::span<const Ray<float>> rays, RayQuery query,
          std::string_view kernel, const TriangleBlocks& triangles, const Executor& executor,
          std::span<RayHit> hits);
void rays(const Wide8Layout& tree, std::span<const Ray<float>> rays, RayQuery query,
          std::string_view kernel, const TriangleBlocks& triangles, const Executor& executor,
          std::span<RayHit> hits);

/// Every hit of every ray, see AnyLayout.
template <class L>
void rays_all(const L&, std::span<const Ray<float>>, std::string_view, const TriangleBlocks&,
              const Executor&, HitSink&) {
    throw std::logic_error("rays_all: not there yet");
}

/// The same on one thread, with the work counted.
Work rays_counted(const BinaryLayout& tree, std::span<const Ray<float>> rays, RayQuery query,
                  std::string_view kernel, const TriangleBlocks& triangles, std::span<RayHit> hits);
Work rays_counted(const Wide8Layout& tree, std::span<const Ray<float>> rays, RayQuery query,
                  std::string_view kernel, const TriangleBlocks& triangles, std::span<RayHit> hits);

} // namespace boxwood
