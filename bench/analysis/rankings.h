#pragma once

#include "bench/analysis/run_index.h"

#include <set>
#include <span>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What a ray contender is ranked among: the peer takes single rays or packets, and the watertight
/// ones stand by themselves. Ours takes all rays in one call; in the order given it answers for
/// both, of any kernel for the looser. One empty lane for every other ask.
std::vector<std::string> lanes_of(const results::Cell& cell, const results::Variant& variant);

/// Tables of the best of each library, by build+query, query, update+query and build, of every
/// scene, ask, lane and number of threads, with the paired ratios to ours and how many times the
/// machine's limit ours takes. Trees alone and whole scenes stand elsewhere (tree_rankings.h,
/// effect_prices.h). Below the rays stand their geometric means. Only right answers are ranked.
std::string rankings_text(const RunIndex& index, std::span<const results::Comparison> comparisons);

/// The cells of ours that stand in those tables.
std::set<std::uint32_t> ranked_cells(const RunIndex& index);

} // namespace boxwood::bench
