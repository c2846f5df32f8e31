#pragma once

#include "trees/builder.h"
#include "trees/ordering/curve_order.h"

namespace boxwood {

/// The items along a Hilbert curve through their centres, and over these a balanced binary tree
/// whose subtrees are cut at multiples of sixteen items. Its order is all that `packed` needs.
/// If the boxes are far longer along one axis than along the others, those of each such axis come
/// together: a block of sixteen then is long one way, not all three. O(n).
struct HilbertBuilder {
    static constexpr std::string_view name = "hilbert";
    static constexpr std::string_view summary =
        "along a Hilbert curve, long boxes of each axis apart; the order that packed likes";

    /// The groups that boxes such as these are best put into.
    static GroupOfBox groups(Boxes boxes);

    Tree build(Boxes boxes, const Executor& executor) const;
    /// centres: the bounds of the boxes' centres, of boxes known to be valid.
    Buffer<std::uint32_t> order(Boxes boxes, const Executor& executor,
                                const Box* centres = nullptr) const;
};

} // namespace boxwood
