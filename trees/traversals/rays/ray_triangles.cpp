#include "kernels/arithmetic/rounding.h"
#include "trees/queries/rays.h"
#include "trees/traversals/rays/ray_tree.h"

#include <stdexcept>
#include <vector>

namespace boxwood::detail {
namespace {

Box in_floats(const Box& box) { return box; }
Box in_floats(const Aabb<double>& box) { return round_outward(box); }

/// Room for nodes and blocks of a known number; each is filled once, by any thread.
template <class Node> class RayTree {
  public:
    using Block = RayBlock<Node>;

    RayTree(std::size_t n_nodes, std::size_t n_blocks, const TriangleMesh& mesh) : mesh_(mesh) {
        if (n_blocks > ray_refs::two || n_nodes > ray_refs::two)
            throw std::length_error("rays: too many triangles for one tree");
        made_.nodes = Buffer<std::byte>(n_nodes * sizeof(Node));
        made_.blocks = Buffer<std::byte>(n_blocks * sizeof(Block));
        nodes_ = reinterpret_cast<Node*>(made_.nodes.data());
        blocks_ = reinterpret_cast<Block*>(made_.blocks.data());
    }

    Node& node(std::size_t i) { return nodes_[i]; }

    /// Fills the leaf of these triangles, at most two blocks from `first_block` on.
    template <class ItemOf>
    std::uint32_t fill_leaf(std::size_t first_block, std::uint32_t n, const ItemOf& item) {
        Block* block = blocks_ + first_block;
        for (std::uint32_t first = 0; first < n; first += Block::lanes, ++block)
            for (std::uint32_t lane = 0; lane < Block::lanes; ++lane) {
                const std::uint32_t triangle = item(first + lane < n ? first + lane : first);
                block->set(lane, mesh_.triangle(triangle), triangle);
            }
        return static_cast<std::uint32_t>(first_block) | ray_refs::leaf |
               (n > Block::lanes ? ray_refs::two : 0);
    }

    TriangleBlocks finish(std::uint32_t root, const Box& bounds) {
        require_ray_range(bounds);
        made_.root = root;
        made_.bounds = bounds;
        return std::move(made_);
    }

  private:
    const TriangleMesh& mesh_;
    TriangleBlocks made_;
    Node* nodes_;
    Block* blocks_;
};

/// Calls f(i) for all i < n, many of them in a row on each thread.
template <class F> void for_rows(std::size_t n, const Executor& executor, const F& f) {
    constexpr std::size_t row = 256;
    executor.for_each((n + row - 1) / row, [&](std::size_t r) {
        for (std::size_t i = r * row; i < std::min(n, (r + 1) * row); ++i)
            f(i);
    });
}

template <std::size_t W>
void set_lane(RayNode<W>& node, std::uint32_t lane, const Box& box, std::uint32_t ref) {
    for (int axis = 0; axis < 3; ++axis) {
        node.plane[axis][lane] = box.min[axis];
        node.plane[3 + axis][lane] = box.max[axis];
    }
    node.ref[lane] = ref;
}

constexpr std::size_t blocks_of(std::size_t items, std::size_t lanes) {
    return (items + lanes - 1) / lanes;
}

/// The copy of a layout with the interface of WideLayout. The children of a node lie side by side,
/// its leaves' triangles too. First every node and leaf gets its number, then threads fill them.
template <class L>
TriangleBlocks copy_of(const L& layout, const TriangleMesh& mesh, const Executor& executor) {
    using Node = RayNodeOf<L>;
    if (layout.empty())
        return {};
    const auto blocks_of_leaf = [&](std::uint32_t ref) {
        return blocks_of(layout.leaf(ref).count, ray_lanes<Node>);
    };
    const auto fill_leaf = [&](RayTree<Node>& tree, std::size_t first_block, std::uint32_t ref) {
        const auto& leaf = layout.leaf(ref);
        return tree.fill_leaf(first_block, leaf.count,
                              [&](std::uint32_t i) { return leaf.ref[i]; });
    };
    const Box bounds = in_floats(layout.bounds());
    if (L::is_leaf(layout.root())) {
        RayTree<Node> tree(0, blocks_of_leaf(layout.root()), mesh);
        return tree.finish(fill_leaf(tree, 0, layout.root()), bounds);
    }

    struct Placed {
        std::uint32_t ref, node;
        std::size_t first_child, first_block;
    };
    std::vector<Placed> placed;
    std::vector<Placed> open{{layout.root(), 0, 0, 0}};
    std::size_t n_nodes = 1, n_blocks = 0;
    while (!open.empty()) {
        Placed top = open.back();
        open.pop_back();
        top.first_child = n_nodes;
        top.first_block = n_blocks;
        placed.push_back(top);
        const auto& block = layout.block(top.ref);
        for (std::uint32_t i = 0; i < block.count; ++i)
            if (L::is_leaf(block.ref[i]))
                n_blocks += blocks_of_leaf(block.ref[i]);
            else
                ++n_nodes;
        // The first child is opened next.
        std::size_t child = n_nodes;
        for (std::uint32_t i = block.count; i-- > 0;)
            if (!L::is_leaf(block.ref[i]))
                open.push_back({block.ref[i], static_cast<std::uint32_t>(--child), 0, 0});
    }

    RayTree<Node> tree(n_nodes, n_blocks, mesh);
    for_rows(placed.size(), executor, [&](std::size_t p) {
        const auto [ref, number, first_child, first_block] = placed[p];
        const auto& block = layout.block(ref);
        Node& node = tree.node(number);
        if constexpr (std::is_same_v<Node, QuantisedBlock>)
            node = block;
        std::uint32_t refs[L::width] = {};
        std::size_t child = first_child, leaf = first_block;
        for (std::uint32_t i = 0; i < block.count; ++i)
            if (L::is_leaf(block.ref[i])) {
                refs[i] = fill_leaf(tree, leaf, block.ref[i]);
                leaf += blocks_of_leaf(block.ref[i]);
            } else {
                refs[i] = static_cast<std::uint32_t>(child++);
            }
        for (std::uint32_t i = 0; i < L::width; ++i)
            if constexpr (std::is_same_v<Node, QuantisedBlock>)
                node.ref[i] = refs[i];
            else
                set_lane(node, i, i < block.count ? in_floats(block.lane(i)) : Box{}, refs[i]);
    });
    return tree.finish(0, bounds);
}

/// Levels from the root down: lane i of block b leads to block 16 b + i of the level below.
TriangleBlocks copy_of(const PackedLayout& layout, const TriangleMesh& mesh,
                       const Executor& executor) {
    constexpr std::size_t W = PackedLayout::width;
    if (layout.empty())
        return {};
    std::size_t n_nodes = 0;
    for (std::size_t l = 1; l < layout.depth(); ++l)
        n_nodes += layout.level(l).size();
    // Two blocks each, but for the last leaf perhaps.
    const std::size_t n_blocks = blocks_of(layout.size(), ray_lanes<RayNode<W>>);
    static_assert(W == 2 * ray_lanes<RayNode<W>>);
    RayTree<RayNode<W>> tree(n_nodes, n_blocks, mesh);
    const auto fill_leaf = [&](std::size_t b) {
        const auto n = static_cast<std::uint32_t>(std::min(W, layout.size() - W * b));
        return tree.fill_leaf(2 * b, n, [&](std::uint32_t i) { return layout.items()[W * b + i]; });
    };
    if (layout.depth() == 1)
        return tree.finish(fill_leaf(0), layout.bounds());
    std::size_t first = 0;
    for (std::size_t l = layout.depth() - 1; l > 0; --l) {
        const std::size_t below = layout.level(l - 1).size();
        const std::size_t first_below = first + layout.level(l).size();
        for_rows(layout.level(l).size(), executor, [&](std::size_t b) {
            for (std::uint32_t i = 0; i < W; ++i) {
                const std::size_t child = W * b + i;
                RayNode<W>& node = tree.node(first + b);
                if (child >= below)
                    set_lane(node, i, Box{}, 0);
                else
                    set_lane(node, i, layout.level(l)[b].lane(i),
                             l > 1 ? static_cast<std::uint32_t>(first_below + child)
                                   : fill_leaf(child));
            }
        });
        first = first_below;
    }
    return tree.finish(0, layout.bounds());
}

} // namespace

} // namespace boxwood::detail

namespace boxwood {

#define X(name, L)                                                                                 \
    TriangleBlocks triangles_of(const L& layout, const TriangleMesh& mesh,                         \
                                const Executor& executor) {                                        \
        return detail::copy_of(layout, mesh, executor);                                            \
    }
BOXWOOD_LANE_LAYOUTS(X)
#undef X

} // namespace boxwood
