#pragma once

#include "bench/advice/advice.h"

#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// What is worth to be timed with care, after a first short sweep.
struct Candidates {
    std::vector<std::string> builders, layouts;
};

/// Of the ways of the first sweep those that may be best for some number of queries: within 1.2
/// times the least time there is for it, where that is less than twice that of all ways, and no
/// other is better in both. The builders are of the ways in `layout`, the layouts of those under
/// `builder`; none where others are far ahead for every number.
Candidates candidates_of(const Advice& first, std::string_view layout, std::string_view builder);

} // namespace boxwood::bench
