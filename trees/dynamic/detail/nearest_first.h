#pragma once

#include "trees/dynamic/detail/lane_groups.h"
#include "trees/function_ref.h"
#include "trees/inspect/work.h"
#include "trees/layouts/packed.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace boxwood::detail {

/// Searches packed trees by branch and bound, the nearer of the blocks at hand first, of those that
/// overlap a box by their centres, for what is nearer than a distance that shrinks. Boxes are
/// within 1e18 of the origin or absent. It holds nothing but a path: memory does not grow with the
/// number of pairs that are near.
class NearestFirst {
  public:
    /// Decides about two items whose boxes may be nearer than `limit`; an item of the second tree,
    /// if there are two. False ends the search.
    using Decide = FunctionRef<bool(std::uint32_t, std::uint32_t)>;

    /// Skipped is what is at a distance of `limit` or more, and nothing that a computation in Real
    /// with a few roundings could find below it.
    template <class Real> static float squared_limit(Real limit) {
        if (!(limit > 0))
            return 0;
        // Squares below 2^-126 of floats, or 2^-1022 of doubles, may have vanished.
        constexpr double tiny = sizeof(Real) == sizeof(float) ? 1e-18 : 1e-150;
        const double wide = (static_cast<double>(limit) + tiny) * (1 + 0x1p-18);
        constexpr double max_root = 1e19;
        return wide < max_root ? static_cast<float>(wide * wide) * (1 + 0x1p-18f)
                               : std::numeric_limits<float>::infinity();
    }

    /// `limit` is read after each decision: squared_limit of the least distance so far. groups: of
    /// the tree of self_pairs; those that may not meet are not decided about, nor blocks of such
    /// opened. `work`, if given, is added to.
    explicit NearestFirst(const float& limit, const LaneGroups* groups = nullptr,
                          Work* work = nullptr)
        : limit_(limit), groups_(groups), work_(work) {}

    /// Items by their distance to a box; the second item handed on is 0.
    bool near_box(const PackedLayout& tree, const Box& box, Decide decide) const;
    /// Every two items of one tree once.
    bool self_pairs(const PackedLayout& tree, Decide decide) const;
    bool tree_pairs(const PackedLayout& a, const PackedLayout& b, Decide decide) const;

    /// Every two items of one tree once whose boxes are at the limit or nearer, which stays: 0 of
    /// those that overlap. In an order that depends on the tree alone.
    bool all_self_pairs(const PackedLayout& tree, Decide decide) const;

  private:
    const float& limit_;
    const LaneGroups* groups_;
    Work* work_;
};

} // namespace boxwood::detail
