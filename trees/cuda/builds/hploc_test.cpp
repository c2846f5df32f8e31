#include "trees/builders/ploc.h"
#include "trees/cuda/builds/hploc.cuh"
#include "trees/cuda/testing/families.h"
#include "trees/ordering/curve_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

namespace boxwood::cuda {
namespace {

struct MadeHploc {
    std::vector<Box> boxes;
    std::vector<std::uint64_t> codes, clusters;
    std::vector<std::uint32_t> items, met;
    std::vector<BinaryNode> nodes;
    std::uint32_t root = 7;
    BinaryView view;

    explicit MadeHploc(const std::vector<Box>& of)
        : boxes(of), codes(of.size()), clusters(of.size()), items(of.size()), met(of.size()),
          nodes(of.empty() ? 0 : of.size() - 1) {
        const CurveOrder order = curve_order(boxes, Curve::hilbert, serial());
        std::ranges::copy(order.order, items.begin());
        std::ranges::copy(order.codes, codes.begin());
        view = {static_cast<std::uint32_t>(boxes.size()), items.data(), nodes.data(), &root};
        make_hploc({view, codes.data(), boxes.data(), clusters.data(), met.data()}, {});
    }
};

/// Checks the boxes, and counts each slot and node once.
struct TraversedHploc {
    const MadeHploc& made;
    std::vector<int> slots, nodes;

    explicit TraversedHploc(const MadeHploc& tree)
        : made(tree), slots(tree.boxes.size()), nodes(tree.nodes.size()) {
        if (!slots.empty())
            traverse(made.root);
        EXPECT_TRUE(std::ranges::all_of(slots, [](int n) { return n == 1; }));
        EXPECT_TRUE(std::ranges::all_of(nodes, [](int n) { return n == 1; }));
    }
    Box traverse(std::uint32_t ref) {
        if (RadixTreeView::is_leaf(ref)) {
            ++slots.at(RadixTreeView::slot(ref));
            return made.boxes[made.items[RadixTreeView::slot(ref)]];
        }
        if (++nodes.at(ref) > 1)
            return {};
        Box box = traverse(made.nodes[ref].left);
        box.extend(traverse(made.nodes[ref].right));
        EXPECT_EQ(box, made.nodes[ref].box);
        return box;
    }
};

TEST(HplocOnDevice, HoldsEachItemOnceUnderExactBoxesAndIsTheSameEachTime) {
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        on_host::set_seed(0);
        const MadeHploc first(family.boxes);
        TraversedHploc{first};
        const auto bytes = std::as_bytes(std::span(first.nodes));
        for (std::uint64_t seed = 1; seed < seeds_for(family); ++seed) {
            on_host::set_seed(seed);
            const MadeHploc made(family.boxes);
            ASSERT_EQ(made.root, first.root) << "seed " << seed;
            ASSERT_TRUE(std::ranges::equal(std::as_bytes(std::span(made.nodes)), bytes))
                << "seed " << seed;
        }
        ASSERT_FALSE(HasFailure());
    }
}

TEST(HplocOnDevice, RefitsToNewBoxes) {
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        if (family.boxes.empty() || family.boxes.size() > 1000)
            continue;
        MadeHploc made(family.boxes);
        const std::uint32_t n = made.view.n;
        std::vector<std::uint32_t> parents(2 * n);
        launch({}, blocks_for(n, radix_threads), radix_threads, find_parents, made.view,
               parents.data(), made.met.data());
        for (std::uint64_t seed = 0; seed < seeds_for(family); ++seed) {
            on_host::set_seed(seed);
            made.boxes = random_boxes(n, .3f, static_cast<unsigned>(seed));
            refit_binary_tree(made.view, made.boxes.data(), parents.data(), made.met.data(), {});
            TraversedHploc{made};
            ASSERT_FALSE(HasFailure()) << "seed " << seed;
        }
    }
}

/// The sum of all inner nodes' areas.
double cost(const MadeHploc& made) {
    double sum = 0;
    for (const BinaryNode& node : made.nodes)
        sum += node.box.half_area();
    return sum;
}

TEST(HplocOnDevice, IsAsGoodAsPlocOfTheCpu) {
    const std::vector<Box> boxes = random_boxes(6000, .02f, 8);
    const Tree ploc = PlocBuilder{.curve = Curve::hilbert}.build(boxes, serial());
    double of_ploc = 0;
    for (std::size_t i = 0; i < ploc.nodes.size(); ++i)
        if (!ploc.is_leaf(i))
            of_ploc += ploc.nodes[i].box.half_area();
    EXPECT_LT(cost(MadeHploc(boxes)), 1.05 * of_ploc);
}

} // namespace
} // namespace boxwood::cuda
