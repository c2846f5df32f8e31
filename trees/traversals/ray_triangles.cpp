#include "kernels/rounding.h"
#include "trees/traversals/rays.h"

#include <stdexcept>
#include <vector>

namespace boxwood {
namespace {

Box in_floats(const Box& box) { return box; }
Box in_floats(const Aabb<double>& box) { return round_outward(box); }

/// Room for nodes and blocks of a known number, filled from the front.
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

    Node& node(std::uint32_t i) { return nodes_[i]; }
    std::uint32_t add_nodes(std::uint32_t n) { return std::exchange(nodes_used_, nodes_used_ + n); }

    /// The leaf of these triangles, at most two blocks of them.
    template <class ItemOf> std::uint32_t add_leaf(std::uint32_t n, const ItemOf& item) {
        const std::uint32_t ref =
            blocks_used_ | ray_refs::leaf | (n > Block::lanes ? ray_refs::two : 0);
        for (std::uint32_t first = 0; first < n; first += Block::lanes) {
            Block& block = blocks_[blocks_used_++];
            for (std::uint32_t lane = 0; lane < Block::lanes; ++lane) {
                const std::uint32_t triangle = item(first + lane < n ? first + lane : first);
                block.set(lane, mesh_.triangle(triangle), triangle);
            }
        }
        return ref;
    }

    TriangleBlocks finish(std::uint32_t root, const Box& bounds) {
        made_.root = root;
        made_.bounds = bounds;
        return std::move(made_);
    }

  private:
    const TriangleMesh& mesh_;
    TriangleBlocks made_;
    Node* nodes_;
    Block* blocks_;
    std::uint32_t nodes_used_ = 0, blocks_used_ = 0;
};

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
/// its leaves' triangles too.
template <class L> TriangleBlocks copy_of(const L& layout, const TriangleMesh& mesh) {
    using Node = RayNodeOf<L>;
    if (layout.empty())
        return {};
    struct Open {
        std::uint32_t ref, node;
    };
    std::vector<Open> open;
    std::size_t n_nodes = 0, n_blocks = 0;
    const auto count_leaf = [&](std::uint32_t ref) {
        n_blocks += blocks_of(layout.leaf(ref).count, ray_lanes<Node>);
    };
    if (L::is_leaf(layout.root()))
        count_leaf(layout.root());
    else
        open.push_back({layout.root(), 0});
    while (!open.empty()) {
        const auto& block = layout.block(open.back().ref);
        open.pop_back();
        ++n_nodes;
        for (std::uint32_t i = 0; i < block.count; ++i)
            if (L::is_leaf(block.ref[i]))
                count_leaf(block.ref[i]);
            else
                open.push_back({block.ref[i], 0});
    }

    RayTree<Node> tree(n_nodes, n_blocks, mesh);
    const auto add_leaf = [&](std::uint32_t ref) {
        const auto& leaf = layout.leaf(ref);
        return tree.add_leaf(leaf.count, [&](std::uint32_t i) { return leaf.ref[i]; });
    };
    std::uint32_t root = 0;
    if (L::is_leaf(layout.root()))
        root = add_leaf(layout.root());
    else
        open.push_back({layout.root(), tree.add_nodes(1)});
    while (!open.empty()) {
        const Open top = open.back();
        open.pop_back();
        const auto& block = layout.block(top.ref);
        Node& node = tree.node(top.node);
        if constexpr (std::is_same_v<Node, QuantisedBlock>)
            node = block;
        std::uint32_t refs[L::width] = {};
        for (std::uint32_t i = 0; i < block.count; ++i)
            refs[i] = L::is_leaf(block.ref[i]) ? add_leaf(block.ref[i]) : tree.add_nodes(1);
        // The first child is opened next.
        for (std::uint32_t i = block.count; i-- > 0;)
            if (!L::is_leaf(block.ref[i]))
                open.push_back({block.ref[i], refs[i]});
        for (std::uint32_t i = 0; i < L::width; ++i)
            if constexpr (std::is_same_v<Node, QuantisedBlock>)
                node.ref[i] = refs[i];
            else
                set_lane(node, i, i < block.count ? in_floats(block.lane(i)) : Box{}, refs[i]);
    }
    return tree.finish(root, in_floats(layout.bounds()));
}

} // namespace

#define X(L)                                                                                       \
    TriangleBlocks triangles_of(const L& layout, const TriangleMesh& mesh) {                       \
        return copy_of(layout, mesh);                                                              \
    }
X(Wide4Layout)
X(Wide8Layout) X(Wide16Layout) X(Wide8LayoutF64) X(Quantised8Layout)
#undef X

    /// Levels from the root down: lane i of block b leads to block 16 b + i of the level below.
    TriangleBlocks triangles_of(const PackedLayout& layout, const TriangleMesh& mesh) {
    constexpr std::size_t W = PackedLayout::width;
    if (layout.empty())
        return {};
    std::size_t n_nodes = 0;
    for (std::size_t l = 1; l < layout.depth(); ++l)
        n_nodes += layout.level(l).size();
    RayTree<RayNode<W>> tree(n_nodes, 2 * layout.level(0).size(), mesh);
    const auto add_leaf = [&](std::size_t b) {
        const auto n = static_cast<std::uint32_t>(std::min(W, layout.size() - W * b));
        return tree.add_leaf(n, [&](std::uint32_t i) { return layout.items()[W * b + i]; });
    };
    if (layout.depth() == 1)
        return tree.finish(add_leaf(0), layout.bounds());
    std::uint32_t first = tree.add_nodes(1);
    for (std::size_t l = layout.depth() - 1; l > 0; --l) {
        const auto below = static_cast<std::uint32_t>(layout.level(l - 1).size());
        const std::uint32_t first_below = l > 1 ? tree.add_nodes(below) : 0;
        for (std::size_t b = 0; b < layout.level(l).size(); ++b)
            for (std::uint32_t i = 0; i < W; ++i) {
                const std::size_t child = W * b + i;
                RayNode<W>& node = tree.node(first + static_cast<std::uint32_t>(b));
                if (child >= below)
                    set_lane(node, i, Box{}, 0);
                else
                    set_lane(node, i, layout.level(l)[b].lane(i),
                             l > 1 ? first_below + static_cast<std::uint32_t>(child)
                                   : add_leaf(child));
            }
        first = first_below;
    }
    return tree.finish(0, layout.bounds());
}

} // namespace boxwood
