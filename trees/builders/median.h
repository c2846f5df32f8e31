#pragma once

#include "trees/builder.h"

namespace boxwood {

/// Top-down build that halves the items at the median centre along the axis of largest spread.
/// The least depth there is; blind to the sizes of boxes. O(n log n).
struct MedianBuilder {
    static constexpr std::string_view name = "median";
    static constexpr std::string_view summary =
        "top-down, halves the items along the axis of largest spread; balanced, blind to sizes";

    Tree build(Boxes boxes, const Executor& executor) const;
};

} // namespace boxwood
