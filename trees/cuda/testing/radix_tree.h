#pragma once

#include "trees/cuda/builds/lbvh.cuh"
#include "trees/ordering/curve_codes.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace boxwood::cuda {

/// A radix tree in the device's memory, with that memory.
struct MadeRadixTree {
    Array<Box> boxes, leaves;
    Array<std::uint32_t> items, met, root{1, {}};
    Array<std::uint64_t> codes;
    Array<RadixNode> nodes;
    RadixTreeView view;

    explicit MadeRadixTree(Boxes of, Curve curve = Curve::hilbert)
        : boxes(of.size(), {}), leaves(of.size(), {}), items(of.size(), {}),
          met(of.empty() ? 0 : of.size() - 1, {}), codes(of.size(), {}), nodes(met.size(), {}) {
        upload(of, boxes, {});
        std::vector<std::uint64_t> code(of.size());
        fine_codes(of, curve, curve_grid(boxwood::measure_centres(of).box, 21), code.data());
        std::iota(items.data(), items.data() + items.size(), 0u);
        std::stable_sort(items.data(), items.data() + items.size(),
                         [&](std::uint32_t a, std::uint32_t b) { return code[a] < code[b]; });
        for (std::size_t i = 0; i < of.size(); ++i)
            codes.data()[i] = code[items.data()[i]];
        view = {static_cast<std::uint32_t>(of.size()), leaves.data(), items.data(), nodes.data(),
                root.data()};
        make_radix_tree(view, codes.data(), boxes.data(), met.data(), {});
    }
};

} // namespace boxwood::cuda
