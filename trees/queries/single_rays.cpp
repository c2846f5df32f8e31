#include "trees/queries/single_rays.h"

#include "trees/layout.h"

namespace boxwood {

SingleRays::SingleRays(const AnyLayout& layout, std::string_view kernel,
                       const TriangleBlocks& triangles)
    : tree_{triangles.nodes.data(), triangles.blocks.data(), triangles.root,
            SlabBounds(triangles.bounds)},
      functions_(layout.single_ray_functions(kernel)), layout_(layout), triangles_(triangles),
      kernel_(kernel) {
    layout.rays({}, RayQuery::closest, kernel, triangles, serial(),
                {}); // refuses an unknown kernel
}

RayHit SingleRays::in_a_batch(const Ray<float>& ray, RayQuery query) const {
    RayHit hit;
    layout_.rays({&ray, 1}, query, kernel_, triangles_, serial(), {&hit, 1});
    return hit;
}

} // namespace boxwood
