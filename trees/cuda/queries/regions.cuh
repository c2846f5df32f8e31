#pragma once

#include "kernels/primitives/sphere.h"
#include "trees/cuda/queries/binary_pairs.cuh"
#include "trees/cuda/queries/sorted_answers.cuh"
#include "trees/queries/box_distance.h"

namespace boxwood::cuda {

/// Points, boxes and balls as queries (trees/queries/points.h, regions.h): which valid boxes share
/// a point with one, by the arithmetic of the CPU.
class SharesPoint {
  public:
    __device__ explicit SharesPoint(const Box& region) : region_(region) {}
    __device__ bool operator()(const Box& box) const { return overlaps(region_, box); }

  private:
    Box region_;
};
class InReach {
  public:
    __device__ explicit InReach(const Sphere<float>& ball)
        : centre_(ball.centre),
          squared_(static_cast<double>(ball.radius) * static_cast<double>(ball.radius)) {}
    __device__ bool operator()(const Box& box) const {
        return squared_distance(centre_, box) <= squared_;
    }

  private:
    Vec3<float> centre_;
    double squared_;
};

/// Whether the region holds any point; one that is not finite is in no box all the same.
__device__ inline bool holds_any(const Vec3<float>&) { return true; }
__device__ inline bool holds_any(const Box& region) {
    return region.min.x <= region.max.x && region.min.y <= region.max.y &&
           region.min.z <= region.max.z;
}
__device__ inline bool holds_any(const Sphere<float>& ball) {
    return is_finite(ball.centre) && ball.radius >= 0;
}

__device__ inline SharesPoint admits_of(const Vec3<float>& point) {
    return SharesPoint({point, point});
}
__device__ inline SharesPoint admits_of(const Box& region) { return SharesPoint(region); }
__device__ inline InReach admits_of(const Sphere<float>& ball) { return InReach(ball); }

/// A query's answer: the item, or of a pass in any order with the query before it.
template <Pass pass>
using RegionAnswer = std::conditional_t<pass == Pass::capped, Pair, std::uint32_t>;

template <Pass pass>
__device__ RegionAnswer<pass> region_answer(std::uint32_t query, std::uint32_t item) {
    if constexpr (pass == Pass::capped)
        return {query, item};
    else
        return item;
}

/// All of a tree.
template <class Admits, class Visit>
__device__ void traverse_tree(const RadixTreeView& tree, const Admits& admits, const Visit& visit) {
    traverse_radix_tree<Traversal::stack>(tree, *tree.root, tree.n, admits, visit);
}
template <class Admits, class Visit>
__device__ void traverse_tree(const BinaryTree& tree, const Admits& admits, const Visit& visit) {
    traverse_binary_tree(tree, *tree.view.root, admits, visit);
}
BOXWOOD_BOTH inline const RadixTreeView& view_of(const RadixTreeView& tree) { return tree; }
BOXWOOD_BOTH inline const BinaryView& view_of(const BinaryTree& tree) { return tree.view; }

/// A thread per point, box or ball.
template <class Tree, Pass pass, class Region>
__global__ void regions_of(Tree tree, const Region* regions, std::uint32_t n,
                           AnswersTo<RegionAnswer<pass>> to) {
    const std::uint32_t query = blockIdx.x * blockDim.x + threadIdx.x;
    if (query >= n)
        return;
    ThreadAnswers<pass, RegionAnswer<pass>> answers(to, query);
    const Region region = regions[query];
    if (view_of(tree).n > 0 && holds_any(region))
        traverse_tree(tree, admits_of(region), [&](std::uint32_t slot) {
            answers.add(region_answer<pass>(query, view_of(tree).items[slot]));
        });
    answers.finish();
}

/// The items whose boxes share a point with each region. sort_answers puts them into the order of
/// the CPU. Tree: RadixTreeView or BinaryTree.
template <Pass pass, class Tree, class Region>
void find_in_regions(const Tree& tree, const Region* regions, std::uint32_t n,
                     const AnswersTo<RegionAnswer<pass>>& to, Stream stream) {
    launch(stream, blocks_for(n, radix_threads), radix_threads, regions_of<Tree, pass, Region>,
           tree, regions, n, to);
}

} // namespace boxwood::cuda
