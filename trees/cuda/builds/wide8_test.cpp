#include "trees/cuda/builds/collapse.cuh"
#include "trees/cuda/builds/hploc.cuh"
#include "trees/cuda/testing/families.h"
#include "trees/layouts/wide.h"
#include "trees/ordering/curve_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace boxwood::cuda {
namespace {

/// Binary trees by both builds, and what they collapse to.
struct OnDevice {
    std::vector<Box> boxes, leaves;
    std::vector<std::uint64_t> codes, clusters;
    std::vector<std::uint32_t> items, met, parents, ranks, queue, wide_parents, wide_met;
    std::vector<RadixNode> radix_nodes;
    std::vector<BinaryNode> hploc_nodes;
    std::vector<CollapseNode> collapse_nodes;
    std::vector<Wide8Node> nodes;
    CollapseRoom::Levels levels;
    std::uint32_t root = 7, n_nodes = 7;
    Box bounds;
    Wide8Tree tree;

    OnDevice(const std::vector<Box>& of, bool radix)
        : boxes(of), leaves(of.size()), codes(of.size()), clusters(of.size()), items(of.size()),
          met(of.size()), parents(2 * of.size()), ranks(of.size()), queue(of.size()),
          wide_parents(of.size()), wide_met(of.size(), 0), collapse_nodes(of.size()),
          nodes(of.size()) {
        const CurveOrder order = curve_order(boxes, Curve::hilbert, serial());
        std::ranges::copy(order.order, items.begin());
        std::ranges::copy(order.codes, codes.begin());
        const auto n = static_cast<std::uint32_t>(boxes.size());
        tree = {{n, nodes.data(), items.data()},
                wide_parents.data(),
                wide_met.data(),
                &n_nodes,
                &bounds};
        if (radix) {
            radix_nodes.resize(n);
            make_radix_tree({n, leaves.data(), items.data(), radix_nodes.data(), &root},
                            codes.data(), boxes.data(), met.data(), {});
        } else {
            hploc_nodes.resize(n);
            make_hploc({{n, items.data(), hploc_nodes.data(), &root},
                        codes.data(),
                        boxes.data(),
                        clusters.data(),
                        met.data()},
                       {});
        }
        collapse();
    }
    void collapse() {
        if (radix_nodes.empty())
            collapse(hploc_nodes);
        else
            collapse(radix_nodes);
    }
    template <class Node> void collapse(const std::vector<Node>& from) {
        Spare spare;
        cuda::collapse(
            BinarySource<Node>{tree.view.n, from.data(), &root, items.data(), boxes.data()},
            {parents.data(), met.data(), ranks.data(), queue.data(), collapse_nodes.data(),
             &levels},
            tree, spare, {});
    }
    std::vector<std::uint8_t> bytes() const {
        std::vector<std::uint8_t> all(n_nodes * sizeof(Wide8Node));
        std::memcpy(all.data(), nodes.data(), all.size());
        return all;
    }
    /// The binary tree as the CPU has it.
    Tree canonical() const {
        Tree made(boxes.size());
        std::uint32_t node = 0, slot = 0;
        if (!boxes.empty())
            radix_nodes.empty() ? put(hploc_nodes, root, made, node, slot)
                                : put(radix_nodes, root, made, node, slot);
        return made;
    }
    template <class Node>
    Box put(const std::vector<Node>& from, std::uint32_t ref, Tree& to, std::uint32_t& node,
            std::uint32_t& slot) const {
        const std::uint32_t self = node++, first = slot;
        Box box;
        if (RadixTreeView::is_leaf(ref)) {
            to.order[slot++] = items[RadixTreeView::slot(ref)];
            box = boxes[to.order[first]];
        } else {
            box = put(from, from[ref].left, to, node, slot);
            box.extend(put(from, from[ref].right, to, node, slot));
        }
        to.nodes[self] = {box, first, slot - first};
        return box;
    }
};

Box lane_of(const Wide8Node& node, unsigned lane) {
    return {{node.plane[0][lane], node.plane[1][lane], node.plane[2][lane]},
            {node.plane[3][lane], node.plane[4][lane], node.plane[5][lane]}};
}

/// Compares a node with a block of the CPU's, and all below them. Counts the nodes.
void expect_block(const OnDevice& made, std::uint32_t node, const Wide8Layout& wanted,
                  std::uint32_t ref, std::vector<int>& seen) {
    const Wide8Node& at = made.nodes.at(node);
    const Block8& block = wanted.block(ref);
    ++seen.at(node);
    for (unsigned lane = 0; lane < 8; ++lane) {
        ASSERT_EQ(lane_of(at, lane), block.lane(lane)) << node << ", lane " << lane;
        const std::uint32_t child = at.ref[lane];
        if (lane >= block.count) {
            EXPECT_EQ(child, nobody);
        } else if (Wide8Layout::is_leaf(ref)) {
            ASSERT_TRUE(Wide8View::is_leaf(child));
            EXPECT_EQ(made.items.at(Wide8View::slot(child)), block.ref[lane]);
        } else if (const Block8& below = wanted.block(block.ref[lane]); below.items == 1) {
            ASSERT_TRUE(Wide8View::is_leaf(child));
            EXPECT_EQ(made.items.at(Wide8View::slot(child)), below.ref[0]);
        } else {
            ASSERT_FALSE(Wide8View::is_leaf(child));
            EXPECT_EQ(made.wide_parents.at(child), node);
            expect_block(made, child, wanted, block.ref[lane], seen);
        }
    }
}

TEST(Wide8OnDevice, IsTheCollapseOfTheCpu) {
    for (const BoxFamily& family : device_families())
        for (const bool radix : {true, false}) {
            SCOPED_TRACE(family.name + (radix ? ", radix" : ", H-PLOC"));
            if (family.boxes.empty())
                continue;
            on_host::set_seed(0);
            OnDevice made(family.boxes, radix);
            const Tree tree = made.canonical();
            const Wide8Layout wanted(tree, serial());
            EXPECT_EQ(made.bounds, tree.nodes[0].box);
            std::vector<int> seen(made.n_nodes);
            expect_block(made, 0, wanted, wanted.root(), seen);
            EXPECT_EQ(seen, std::vector<int>(made.n_nodes, 1));
            const std::vector<std::uint8_t> first = made.bytes();
            for (std::uint64_t seed = 1; seed < seeds_for(family); ++seed) {
                on_host::set_seed(seed);
                made.collapse();
                ASSERT_EQ(made.bytes(), first) << "seed " << seed;
            }
            ASSERT_FALSE(HasFailure());
        }
}

/// Checks that all boxes are those of what is below them, and gives the node's own.
Box expect_boxes(const OnDevice& made, std::uint32_t node) {
    Box all;
    for (unsigned lane = 0; lane < 8; ++lane) {
        const std::uint32_t ref = made.nodes[node].ref[lane];
        const Box box = ref == nobody             ? Box{}
                        : Wide8View::is_leaf(ref) ? made.boxes[made.items[Wide8View::slot(ref)]]
                                                  : expect_boxes(made, ref);
        EXPECT_EQ(lane_of(made.nodes[node], lane), box);
        all.extend(box);
    }
    return all;
}

TEST(Wide8OnDevice, RefitsToNewBoxes) {
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        OnDevice made(family.boxes, true);
        for (std::uint64_t seed = 0; seed < seeds_for(family); ++seed) {
            on_host::set_seed(seed);
            made.boxes = random_boxes(family.boxes.size(), .3f, static_cast<unsigned>(seed));
            refit_wide8_tree(made.tree, made.boxes.data(), {});
            if (!family.boxes.empty()) {
                ASSERT_EQ(made.bounds, expect_boxes(made, 0));
            }
            ASSERT_TRUE(std::ranges::all_of(made.wide_met, [](auto n) { return n == 0; }));
        }
        ASSERT_FALSE(HasFailure());
    }
}

} // namespace
} // namespace boxwood::cuda
