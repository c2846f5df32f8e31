#pragma once

#include "trees/layouts/packed.h"

namespace boxwood::detail {

/// n boxes anywhere: box i lies `stride` bytes beyond the first times i, or times index[i].
struct PackedSource {
    const Box* first;
    std::size_t stride;
    const std::uint32_t* index; ///< may be null
    std::size_t n;

    const Box& operator[](std::size_t i) const {
        return *reinterpret_cast<const Box*>(reinterpret_cast<const std::byte*>(first) +
                                             stride * (index ? index[i] : i));
    }
};

/// Makes the blocks [begin, end) of those that hold the boxes in turn, and their bounds.
void fill_packed(const PackedSource& boxes, std::size_t begin, std::size_t end, PackedBlock* blocks,
                 Box* bounds);

} // namespace boxwood::detail
