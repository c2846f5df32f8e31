#pragma once

#include "trees/builder.h"
#include "trees/ordering/curve_order.h"

#include <array>

namespace boxwood {

/// Linear build: the items along a space-filling curve, and over them the binary radix tree of
/// their codes; equal codes are split by the bits of item or place. Codes have 63 bits, or 30 where
/// these tell nearly all items apart, for half the time. Blind to the sizes of boxes. O(n), depth
/// at most 63 + 30.
/// Source: Lauterbach et al. 2009, "Fast BVH Construction on GPUs"; one bottom-up pass as in
/// Apetrei 2014, here from the last item to the first, so that nodes are written in a row.
struct LbvhBuilder {
    static constexpr std::string_view name = "lbvh";
    static constexpr std::string_view summary =
        "items along a space-filling curve, split by the bits of their codes; fastest to build";

    Curve curve = Curve::morton;

    static auto settings() {
        return std::array{Setting<LbvhBuilder>("curve", "the space-filling curve",
                                               &LbvhBuilder::curve, {"morton", "hilbert"})};
    }

    Tree build(Boxes boxes, const Executor& executor) const;

    /// That of the tree.
    Buffer<std::uint32_t> order(Boxes boxes, const Executor& executor) const;
};

} // namespace boxwood
