#pragma once

#include "kernels/arithmetic/rounding.h"
#include "trees/cuda/queries/regions.cuh"
#include "trees/queries/box_distance.h"
#include "trees/queries/nearest.h"

namespace boxwood::cuda {

/// The k nearest items of one point so far: a heap with the farthest at its front, in the memory of
/// the answer, k > 0. At first none, infinitely far.
class NearestItems {
  public:
    __device__ NearestItems(Neighbour* to, std::uint32_t k) : heap_(to), k_(k) {
        for (std::uint32_t i = 0; i < k; ++i)
            heap_[i] = {Neighbour::none, Neighbour::nowhere};
    }

    /// Nothing farther than this matters.
    __device__ double worst() const { return worst_; }
    __device__ void offer(const Neighbour& item) {
        if (item.squared_distance > worst_ || !nearer(item, heap_[0]))
            return;
        put(0, k_, item);
        worst_ = heap_[0].squared_distance;
    }
    /// Nearest first.
    __device__ void sort() {
        for (std::uint32_t n = k_ - 1; n > 0; --n) {
            const Neighbour last = heap_[n];
            heap_[n] = heap_[0];
            put(0, n, last);
        }
    }

  private:
    __device__ static bool nearer(const Neighbour& a, const Neighbour& b) {
        return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                        : a.item < b.item;
    }
    /// Puts it in place of the i-th of n, or below.
    __device__ void put(std::uint32_t i, std::uint32_t n, const Neighbour& item) {
        for (std::uint32_t child; (child = 2 * i + 1) < n; i = child) {
            if (child + 1 < n && nearer(heap_[child], heap_[child + 1]))
                ++child;
            if (!nearer(item, heap_[child]))
                break;
            heap_[i] = heap_[child];
        }
        heap_[i] = item;
    }

    Neighbour* heap_;
    std::uint32_t k_;
    double worst_ = Neighbour::nowhere;
};

__device__ inline Box box_of(const RadixTreeView& tree, std::uint32_t ref) { return tree.box(ref); }
__device__ inline Box box_of(const BinaryTree& tree, std::uint32_t ref) {
    return RadixTreeView::is_leaf(ref) ? tree.leaf(RadixTreeView::slot(ref))
                                       : tree.view.nodes[ref].box;
}

/// Offers the leaves of a subtree, left before right, without memory: where a tree is so deep that
/// the stack of search_tree is full.
__device__ inline void search_subtree(const BinaryTree& tree, std::uint32_t top, Vec3<float> point,
                                      NearestItems& best) {
    for (std::uint32_t at = top;;) {
        const double distance = squared_distance(point, box_of(tree, at));
        if (RadixTreeView::is_leaf(at)) {
            best.offer({tree.view.items[RadixTreeView::slot(at)], distance});
        } else if (distance <= best.worst()) {
            at = tree.view.nodes[at].left;
            continue;
        }
        bool is_left = false;
        while (at != top && !is_left) {
            const std::uint32_t parent = tree.parent(at);
            is_left = tree.view.nodes[parent].left == at;
            at = is_left ? tree.view.nodes[parent].right : parent;
        }
        if (!is_left)
            return;
    }
}
__device__ inline void search_subtree(const RadixTreeView&, std::uint32_t, Vec3<float>,
                                      NearestItems&) {} // never so deep

/// Offers every leaf that may be near enough, the nearer child first. Distances in doubles, as the
/// CPU has them, are rounded monotonely: no box is farther than one within it.
template <unsigned room, class Tree>
__device__ void search_tree(const Tree& tree, Vec3<float> point, NearestItems& best) {
    struct Waiting {
        std::uint32_t ref;
        float bound; ///< at most the squared distance
    };
    Waiting stack[room];
    unsigned depth = 0;
    const auto& view = view_of(tree);
    for (std::uint32_t at = *view.root;;) {
        if (RadixTreeView::is_leaf(at)) {
            best.offer(
                {view.items[RadixTreeView::slot(at)], squared_distance(point, box_of(tree, at))});
        } else {
            std::uint32_t near = view.nodes[at].left, far = view.nodes[at].right;
            double to_near = squared_distance(point, box_of(tree, near)),
                   to_far = squared_distance(point, box_of(tree, far));
            if (to_far < to_near) {
                const std::uint32_t ref = near;
                near = far;
                far = ref;
                const double distance = to_near;
                to_near = to_far;
                to_far = distance;
            }
            if (to_far <= best.worst()) {
                if (depth < room)
                    stack[depth++] = {far, round_down(to_far)};
                else
                    search_subtree(tree, far, point, best);
            }
            if (to_near <= best.worst()) {
                at = near;
                continue;
            }
        }
        do {
            if (depth == 0)
                return;
            --depth;
        } while (static_cast<double>(stack[depth].bound) > best.worst());
        at = stack[depth].ref;
    }
}

/// A thread per point. Tree: RadixTreeView, whose depth is known, or BinaryTree.
template <class Tree, unsigned room = radix_depth>
__global__ void nearest_of(Tree tree, const Vec3<float>* points, std::uint32_t n, std::uint32_t k,
                           Neighbour* out) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n)
        return;
    NearestItems best(out + std::size_t{i} * k, k);
    const Vec3<float> point = points[i];
    if (view_of(tree).n > 0 && is_finite(point))
        search_tree<room>(tree, point, best);
    best.sort();
}

/// The k nearest items to each point, as trees/queries/nearest.h: out[k i ...] answers points[i].
template <unsigned room = radix_depth, class Tree>
void find_nearest(const Tree& tree, const Vec3<float>* points, std::uint32_t n, std::uint32_t k,
                  Neighbour* out, Stream stream) {
    if (k > 0)
        launch(stream, blocks_for(n, radix_threads), radix_threads, nearest_of<Tree, room>, tree,
               points, n, k, out);
}

} // namespace boxwood::cuda
