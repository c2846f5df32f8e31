#pragma once

#include "trees/cuda/builds/wide8.cuh"
#include "trees/cuda/queries/rays.cuh"

namespace boxwood::cuda {

/// A node's children that a ray may hit, nearest first, three bits each above their number.
class Wide8Order {
  public:
    __device__ void add(unsigned child, unsigned place) {
        bits_ = (bits_ | child << (4 + 3 * place)) + 1;
    }
    __device__ bool empty() const { return (bits_ & 15) == 0; }
    __device__ unsigned take() {
        const unsigned child = bits_ >> 4 & 7, left = (bits_ & 15) - 1;
        bits_ = bits_ >> 7 << 4 | left;
        return child;
    }

  private:
    std::uint32_t bits_ = 0;
};

/// Four numbers in one load.
struct alignas(16) FourFloats {
    float at[4];
};

__device__ inline Box child_box(const Wide8Node& node, unsigned child) {
    return {{node.plane[0][child], node.plane[1][child], node.plane[2][child]},
            {node.plane[3][child], node.plane[4][child], node.plane[5][child]}};
}

__device__ inline Wide8Order children_hit(const Wide8Node& node, const RaySlabs& slabs, float t_min,
                                          float t_max) {
    constexpr float none = Aabb<float>::inf;
    float entry[8]; // `none`: not hit
    for (unsigned half = 0; half < 2; ++half) {
        FourFloats plane[6];
        for (int p = 0; p < 6; ++p)
            plane[p] = *reinterpret_cast<const FourFloats*>(node.plane[p] + 4 * half);
        for (unsigned i = 0; i < 4; ++i) {
            const RaySpan span = clip(slabs,
                                      {{plane[0].at[i], plane[1].at[i], plane[2].at[i]},
                                       {plane[3].at[i], plane[4].at[i], plane[5].at[i]}},
                                      t_min, t_max);
            entry[4 * half + i] = span.hit() && span.entry < none ? span.entry : none;
        }
    }
    Wide8Order order;
    for (unsigned i = 0; i < 8; ++i) {
        if (entry[i] == none)
            continue;
        unsigned place = 0;
        for (unsigned j = 0; j < 8; ++j)
            place += entry[j] < entry[i] || (j < i && entry[j] == entry[i]);
        order.add(i, place);
    }
    return order;
}

/// As that of the binary tree. What waits is kept by node: the children that are left of it. There
/// is room for as many levels as a radix tree has; a tree that was made by merging may have more.
template <class Test>
__device__ bool trace(const Wide8View& tree, const Ray<float>& ray, const float& t_max,
                      const Test& test) {
    struct Waiting {
        std::uint32_t node;
        Wide8Order order;
    };
    Waiting stack[radix_depth];
    unsigned depth = 0;
    Box bounds;
    for (unsigned child = 0; child < Wide8Node::width; ++child)
        bounds.extend(child_box(tree.nodes[0], child));
    const RaySlabs slabs(ray, bounds);
    Waiting open{0, children_hit(tree.nodes[0], slabs, ray.t_min, t_max)};
    for (;;) {
        if (open.order.empty()) {
            if (depth == 0)
                return true;
            open = stack[--depth];
        }
        const Wide8Node& node = tree.nodes[open.node];
        const unsigned child = open.order.take();
        // t_max may have become less since.
        if (!clip(slabs, child_box(node, child), ray.t_min, t_max).hit())
            continue;
        const std::uint32_t ref = node.ref[child];
        if (Wide8View::is_leaf(ref)) {
            if (test(Wide8View::slot(ref)))
                return true;
            continue;
        }
        if (!open.order.empty()) {
            if (depth == radix_depth)
                return false;
            stack[depth++] = open;
        }
        open = {ref, children_hit(tree.nodes[ref], slabs, ray.t_min, t_max)};
    }
}

} // namespace boxwood::cuda
