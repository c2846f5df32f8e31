#include "trees/cuda/hploc.cuh"
#include "trees/cuda/testing/families.h"
#include "trees/ordering/curve_codes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace boxwood::cuda {
namespace {

struct OnDevice {
    std::vector<Box> boxes;
    std::vector<std::uint64_t> codes;
    std::vector<std::uint32_t> items, clusters, met;
    std::vector<BinaryNode> nodes;
    std::uint32_t n_nodes = 7, root = 7;

    explicit OnDevice(std::vector<Box> of)
        : boxes(std::move(of)), codes(boxes.size()), items(boxes.size()), clusters(boxes.size()),
          met(boxes.size()), nodes(boxes.empty() ? 0 : boxes.size() - 1) {
        std::vector<std::uint64_t> code(boxes.size());
        fine_codes(boxes, Curve::hilbert, curve_grid(boxwood::measure_centres(boxes).box, 21),
                   code.data());
        std::iota(items.begin(), items.end(), 0u);
        std::ranges::stable_sort(items, {}, [&](std::uint32_t i) { return code[i]; });
        for (std::size_t i = 0; i < items.size(); ++i)
            codes[i] = code[items[i]];
        make_hploc({static_cast<std::uint32_t>(boxes.size()), codes.data(), items.data(),
                    boxes.data(), nodes.data(), clusters.data(), met.data(), &n_nodes, &root},
                   {});
    }
};

/// Checks boxes, counts each item and node once, and gives the shape without the nodes' numbers.
struct Walked {
    const OnDevice& made;
    std::vector<int> items, nodes;
    std::vector<std::uint32_t> shape;

    explicit Walked(const OnDevice& tree)
        : made(tree), items(tree.boxes.size()), nodes(tree.nodes.size()) {
        if (!items.empty())
            walk(made.root);
    }
    Box walk(std::uint32_t ref) {
        shape.push_back(RadixTreeView::is_leaf(ref) ? ref : 0);
        if (RadixTreeView::is_leaf(ref)) {
            ++items.at(RadixTreeView::slot(ref));
            return made.boxes[RadixTreeView::slot(ref)];
        }
        if (++nodes.at(ref) > 1)
            return {};
        Box box = walk(made.nodes[ref].left);
        box.extend(walk(made.nodes[ref].right));
        EXPECT_EQ(box, made.nodes[ref].box);
        return box;
    }
};

TEST(HplocOnDevice, HoldsEachItemOnceUnderExactBoxes) {
    for (const BoxFamily& family : device_families()) {
        SCOPED_TRACE(family.name);
        std::vector<std::uint32_t> shape;
        for (std::uint64_t seed = 0; seed < fibre_seeds; ++seed) {
            on_host::set_seed(seed);
            const OnDevice made(family.boxes);
            const Walked walked(made);
            EXPECT_TRUE(std::ranges::all_of(walked.items, [](int n) { return n == 1; }));
            EXPECT_TRUE(std::ranges::all_of(walked.nodes, [](int n) { return n == 1; }));
            if (!family.boxes.empty()) {
                EXPECT_EQ(made.n_nodes, made.nodes.size());
            }
            if (seed == 0)
                shape = walked.shape;
            ASSERT_EQ(walked.shape, shape) << "the tree depends on the seed " << seed;
            ASSERT_FALSE(HasFailure());
        }
    }
}

} // namespace
} // namespace boxwood::cuda
