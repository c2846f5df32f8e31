#pragma once

#include "trees/builder.h"
#include "trees/ordering/curve_order.h"

#include <array>

namespace boxwood {

/// Bottom-up build by parallel locally-ordered clustering: of the clusters along a space-filling
/// curve each two merge that are each other's nearest, by the surface area of their union, among
/// the `radius` next ones on either side; again until one is left. Rounds run within tiles of
/// clusters that are close along the curve, then over what is left of all tiles.
/// A round that merges fewer than 1 in 16 also merges neighbours whatever they are, so that the
/// depth stays below 11 log2(n) + 64 and the time O(n) on nested and identical boxes, too.
/// Source: Meister and Bittner 2018, "Parallel Locally-Ordered Clustering for Bounding Volume
/// Hierarchy Construction".
struct PlocBuilder {
    static constexpr std::string_view name = "ploc";
    static constexpr std::string_view summary =
        "bottom-up, merges mutual nearest clusters along a space-filling curve (Meister 2018)";

    int radius = 8; ///< clusters looked at on either side
    Curve curve = Curve::morton;

    static constexpr int max_radius = 31;
    static auto settings() {
        using Owner = PlocBuilder;
        return std::array{Setting<Owner>("radius", "clusters looked at on either side",
                                         &Owner::radius, 1, max_radius),
                          Setting<Owner>("curve", "the space-filling curve", &Owner::curve,
                                         {"morton", "hilbert"})};
    }

    Tree build(Boxes boxes, const Executor& executor) const;
};

} // namespace boxwood
