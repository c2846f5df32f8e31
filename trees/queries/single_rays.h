#pragma once

#include "kernels/ray_box/fused_slabs.h"
#include "trees/queries/rays.h"

#include <string>
#include <string_view>

namespace boxwood {

class AnyLayout;

/// What the traversal of one ray reads, the same for all rays.
struct SingleRayTree {
    const std::byte *nodes, *blocks; ///< of TriangleBlocks
    std::uint32_t root;              ///< ray_refs
    SlabBounds bounds;
};

/// The traversal of a layout by one ray, for one kernel on this machine; null where a batch of one
/// has to do.
struct SingleRayFunctions {
    RayHit (*closest)(const SingleRayTree& tree, const Ray<float>& ray) = nullptr;
    bool (*any)(const SingleRayTree& tree, const Ray<float>& ray) = nullptr;
};

#define X(name, L)                                                                                 \
    SingleRayFunctions single_ray_functions(const L& layout, std::string_view kernel);
BOXWOOD_TRAVERSED_LAYOUTS(X)
#undef X

/// Rays at a mesh for callers who have one at a time: each is answered at once, as AnyLayout::rays
/// answers it, but where a kernel in plain numbers is wrong about a t (products that underflow, in
/// meshes of 1e-20 across): there the two may find different triangles. What all rays share is
/// looked up here, so that a call finds no name, no layout and no instruction set, and allocates
/// nothing; but kernels other than moller_trumbore_f32, _f64 and watertight, the binary layouts and
/// trees too deep for a stack of 4 KiB go through AnyLayout. Any number of threads may call it at a
/// time. Layout and triangles must outlive it.
class SingleRays {
  public:
    /// As AnyLayout::rays: `triangles` are those of this very layout. An unknown kernel throws
    /// std::invalid_argument.
    SingleRays(const AnyLayout& layout, std::string_view kernel, const TriangleBlocks& triangles);

    /// The hit with the least t, ties to the lowest triangle.
    RayHit closest(const Ray<float>& ray) const {
        return functions_.closest ? functions_.closest(tree_, ray)
                                  : in_a_batch(ray, RayQuery::closest);
    }
    /// Whether there is a hit.
    bool any(const Ray<float>& ray) const {
        return functions_.any ? functions_.any(tree_, ray) : in_a_batch(ray, RayQuery::any).hit();
    }

  private:
    RayHit in_a_batch(const Ray<float>& ray, RayQuery query) const;

    SingleRayTree tree_;
    SingleRayFunctions functions_;
    const AnyLayout& layout_;
    const TriangleBlocks& triangles_;
    std::string kernel_;
};

} // namespace boxwood
