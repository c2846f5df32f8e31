#pragma once

#include "bench/analysis/run_index.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// Contenders of the ask scene_queries: only what the scene calls for, everything on, and the scene
/// without one of its effects, whose word follows.
inline constexpr std::string_view scene_queries_word = "scene_queries", required_word = "required",
                                  everything_word = "all_stages",
                                  without_word = "required.without_";

/// One stage of one cell's plan: sums over the frames of one pass.
struct StageSums {
    std::string name;
    bool is_required = false;
    std::uint64_t calls = 0, items = 0, bytes = 0;
    double ns = results::missing; ///< median over the rounds
};
/// The rows of /effects by cell, the stages in the order of the plan.
std::map<std::uint32_t, std::vector<StageSums>> stages_of(const results::Results& results);

/// The two sides of one scene that plays with everything it asks, on one number of threads.
struct PlayedScene {
    const results::Cell *required = nullptr, *everything = nullptr;
    std::vector<const results::Cell*> without; ///< one effect each
};
/// In the order of the file; wrong answers are left out, and scenes without `required`.
std::vector<PlayedScene> played_scenes(const RunIndex& index);

/// The effects ledger of each scene: stage by stage whether the scene calls for it, its calls, time
/// and memory, beside the same with everything on. Stages that neither runs are named below.
std::string ledgers_text(const RunIndex& index);

} // namespace boxwood::bench
