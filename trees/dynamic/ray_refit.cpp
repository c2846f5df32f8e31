#include "trees/dynamic/ray_refit.h"

#include <algorithm>

namespace boxwood {
using namespace detail;
namespace {

/// By halves, in loops without branches. n is a power of two.
template <std::size_t n> float min_of(const float (&values)[n]) {
    float half[n / 2];
    for (std::size_t i = 0; i < n / 2; ++i)
        half[i] = values[i + n / 2] < values[i] ? values[i + n / 2] : values[i];
    if constexpr (n == 2)
        return half[0];
    else
        return min_of(half);
}
template <std::size_t n> float greatest(const float (&values)[n]) {
    float half[n / 2];
    for (std::size_t i = 0; i < n / 2; ++i)
        half[i] = values[i + n / 2] > values[i] ? values[i + n / 2] : values[i];
    if constexpr (n == 2)
        return half[0];
    else
        return greatest(half);
}

/// Of all lanes; those not in use repeat another.
template <std::size_t lanes> Box bounds_of(const TriangleBlock<lanes>& block) {
    Box bounds;
    for (int axis = 0; axis < 3; ++axis) {
        float low[lanes], high[lanes];
        for (std::size_t i = 0; i < lanes; ++i) {
            const float a = block.corner[0][axis][i], b = block.corner[1][axis][i],
                        c = block.corner[2][axis][i];
            const float ab_low = b < a ? b : a, ab_high = b > a ? b : a;
            low[i] = c < ab_low ? c : ab_low;
            high[i] = c > ab_high ? c : ab_high;
        }
        bounds.min[axis] = min_of(low);
        bounds.max[axis] = greatest(high);
    }
    return bounds;
}

/// Of all lanes; those not in use are the empty box, which adds nothing.
template <std::size_t W> Box bounds_of(const RayNode<W>& node) {
    return {{min_of(node.plane[0]), min_of(node.plane[1]), min_of(node.plane[2])},
            {greatest(node.plane[3]), greatest(node.plane[4]), greatest(node.plane[5])}};
}

template <std::size_t W> void set_lane(RayNode<W>* nodes, std::uint32_t at, const Box& box) {
    RayNode<W>& node = nodes[at / W];
    for (int axis = 0; axis < 3; ++axis) {
        node.plane[axis][at % W] = box.min[axis];
        node.plane[3 + axis][at % W] = box.max[axis];
    }
}

} // namespace

void RayRefit::start(const TriangleBlocks& tree, std::size_t triangles) {
    const std::size_t n_nodes = tree.nodes.size() / sizeof(Node);
    const std::size_t n_blocks = tree.blocks.size() / sizeof(Block);
    const auto* nodes = reinterpret_cast<const Node*>(tree.nodes.data());
    const auto* blocks = reinterpret_cast<const Block*>(tree.blocks.data());
    leaf_of_.assign(triangles, none);
    above_.assign(n_blocks, none);
    above_node_.assign(n_nodes, none);
    is_noted_.assign(n_blocks, 0);
    is_stale_.assign(n_nodes, 0);
    leaves_.clear();

    const auto note_leaf = [&](std::uint32_t ref, std::uint32_t above) {
        const std::uint32_t first = ray_refs::index(ref);
        above_[first] = above;
        for (std::uint32_t b = first; b <= first + ((ref & ray_refs::two) != 0); ++b)
            for (const std::uint32_t triangle : blocks[b].id)
                leaf_of_[triangle] = first;
    };
    if (n_nodes == 0 && n_blocks > 0)
        note_leaf(tree.root, none);
    for (std::uint32_t n = 0; n < n_nodes; ++n)
        for (std::uint32_t lane = 0; lane < W; ++lane) {
            const std::uint32_t ref = nodes[n].ref[lane];
            const auto at = static_cast<std::uint32_t>(n * W + lane);
            if (ray_refs::is_leaf(ref))
                note_leaf(ref, at);
            else if (ref != 0) // else not in use: node 0 is the root
                above_node_[ref] = at;
        }
}

void RayRefit::note(std::size_t first, std::size_t last) {
    for (std::size_t triangle = first; triangle < last; ++triangle) {
        const std::uint32_t leaf = leaf_of_[triangle];
        if (is_noted_[leaf] == 0) {
            is_noted_[leaf] = 1;
            leaves_.push_back(leaf);
        }
    }
}

/// Nodes come after the node above them, so that one pass from the last to the first is enough.
void RayRefit::refit(TriangleBlocks& tree, const TriangleMesh& mesh, const Executor& executor) {
    auto* nodes = reinterpret_cast<Node*>(tree.nodes.data());
    auto* blocks = reinterpret_cast<Block*>(tree.blocks.data());
    const auto refill = [&](std::uint32_t leaf) {
        const std::uint32_t above = above_[leaf];
        const std::uint32_t ref = above == none ? tree.root : nodes[above / W].ref[above % W];
        Box bounds;
        for (std::uint32_t b = leaf; b <= leaf + ((ref & ray_refs::two) != 0); ++b) {
            Block& block = blocks[b];
            for (std::size_t lane = 0; lane < Block::lanes; ++lane)
                block.set(lane, mesh.triangle(block.id[lane]), block.id[lane]);
            bounds.extend(bounds_of(block));
        }
        if (above == none)
            tree.bounds = bounds;
        else
            set_lane(nodes, above, bounds);
    };
    if (leaves_.size() > above_.size() / 32) { // many of them: in the order of memory
        leaves_.clear();
        for (std::uint32_t leaf = 0; leaf < is_noted_.size(); ++leaf)
            if (is_noted_[leaf] != 0)
                leaves_.push_back(leaf);
    }
    constexpr std::size_t row = 64;
    executor.for_each((leaves_.size() + row - 1) / row, [&](std::size_t r) {
        for (std::size_t i = r * row; i < std::min(leaves_.size(), (r + 1) * row); ++i)
            refill(leaves_[i]);
    });
    for (const std::uint32_t leaf : leaves_) {
        is_noted_[leaf] = 0;
        if (above_[leaf] != none)
            is_stale_[above_[leaf] / W] = 1;
    }
    leaves_.clear();
    for (std::size_t n = is_stale_.size(); n-- > 0;) {
        if (is_stale_[n] == 0)
            continue;
        is_stale_[n] = 0;
        const Box bounds = bounds_of(nodes[n]);
        if (n == 0) {
            tree.bounds = bounds;
        } else {
            set_lane(nodes, above_node_[n], bounds);
            is_stale_[above_node_[n] / W] = 1;
        }
    }
    if (!tree.blocks.empty())
        require_ray_range(tree.bounds);
}

double RayRefit::surface(const TriangleBlocks& tree) {
    const auto* nodes = reinterpret_cast<const Node*>(tree.nodes.data());
    double sum = 0;
    for (std::size_t n = 0; n < tree.nodes.size() / sizeof(Node); ++n) {
        const auto& plane = nodes[n].plane;
        float areas[W]; // of the extents as floats: a measure, not a bound
        for (std::size_t i = 0; i < W; ++i) {
            const float x = plane[3][i] - plane[0][i], y = plane[4][i] - plane[1][i],
                        z = plane[5][i] - plane[2][i];
            areas[i] = nodes[n].ref[i] != 0 ? x * y + y * z + z * x : 0;
        }
        for (const float area : areas)
            sum += static_cast<double>(area);
    }
    const double root = tree.blocks.empty() ? 0 : tree.bounds.half_area();
    return root > 0 && sum <= root * 1e30 ? sum / root : 0;
}

std::size_t RayRefit::bytes() const {
    return (leaf_of_.capacity() + above_.capacity() + above_node_.capacity() + leaves_.capacity()) *
               sizeof(std::uint32_t) +
           is_noted_.capacity() + is_stale_.capacity();
}

} // namespace boxwood
