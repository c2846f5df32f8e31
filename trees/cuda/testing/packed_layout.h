#pragma once

#include "trees/cuda/builds/packed.cuh"

#include <cstring>
#include <span>

namespace boxwood::cuda {

inline bool same_bytes(const void* a, const void* b, std::size_t n) {
    return n == 0 || std::memcmp(a, b, n) == 0;
}

/// A packed layout in the device's memory, with that memory.
struct MadePackedLayout {
    Array<Box> boxes, bounds{1, {}};
    Array<std::uint32_t> order, items;
    Array<PackedBlock> blocks;
    PackedView view;

    MadePackedLayout(Boxes of, std::span<const std::uint32_t> by)
        : boxes(of.size(), {}), order(by.size(), {}),
          view(packed_levels(static_cast<std::uint32_t>(of.size()))) {
        upload(of, boxes, {});
        upload(by, order, {});
        blocks = {view.first[view.depth], {}};
        items = {std::size_t{view.leaves()} * view.width, {}};
        view.blocks = blocks.data();
        view.items = items.data();
        fill_packed(view, boxes.data(), order.data(), bounds.data(), {});
    }
};

} // namespace boxwood::cuda
