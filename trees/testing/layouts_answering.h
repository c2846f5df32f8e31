#pragma once

#include "trees/layout.h"

#include <algorithm>
#include <initializer_list>
#include <vector>

namespace boxwood {

/// The layouts of the registry that answer all of these queries.
inline std::vector<LayoutEntry> layouts_answering(std::initializer_list<Query> queries) {
    std::vector<LayoutEntry> found;
    for (const LayoutEntry& entry : layouts())
        if (std::ranges::all_of(queries, [&](Query query) { return entry.answers(query); }))
            found.push_back(entry);
    return found;
}

} // namespace boxwood
