#pragma once

#include "trees/builder.h"

namespace boxwood {

/// Inserts the items one by one, in the order given, into a `DynamicTree`, then makes the canonical
/// tree of it: what a tree that lives through many changes is like. Serial on every executor. O(n
/// log n).
struct IncrementalBuilder {
    static constexpr std::string_view name = "incremental";
    static constexpr std::string_view summary =
        "inserts items one by one by surface area, with rotations; serial, depth below 3.5 log2 n";

    Tree build(Boxes boxes, const Executor& executor) const;
};

} // namespace boxwood
