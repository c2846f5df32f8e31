#pragma once

#include "bench/run_index.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// Contenders of the ask scene_asks: only what the scene calls for, everything on, and the scene
/// without one of its effects, whose word follows.
inline constexpr std::string_view scene_asks_word = "scene_asks", called_for_word = "called_for",
                                  everything_word = "everything",
                                  without_word = "called_for.without_";

/// One stage of one cell's plan: sums over the frames of one pass.
struct StageSums {
    std::string name;
    bool is_called_for = false;
    std::uint64_t calls = 0, items = 0, bytes = 0;
    double ns = results::missing; ///< median over the rounds
};
/// The rows of /effects by cell, the stages in the order of the plan.
std::map<std::uint32_t, std::vector<StageSums>> stages_of(const results::Results& results);

/// The two sides of one scene that plays with everything it asks, on one number of threads.
struct PlayedScene {
    const results::Cell *called_for = nullptr, *everything = nullptr;
    std::vector<const results::Cell*> without; ///< one effect each
};
/// In the order of the file; wrong answers are left out, and scenes without `called_for`.
std::vector<PlayedScene> played_scenes(const RunIndex& index);

/// The effects ledger of each scene: stage by stage whether the scene calls for it, its calls, time
/// and memory, beside the same with everything on. Stages that neither runs are named below.
std::string ledgers_text(const RunIndex& index);

} // namespace boxwood::bench
