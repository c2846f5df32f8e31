#pragma once

#include "bench/plan/block_reader.h"
#include "bench/tasks/task.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// One `[[cells]]` block and the tasks that it names. What else it says the tasks read.
struct Block {
    BlockReader reader;
    std::vector<const Task*> tasks;
    std::optional<unsigned> rounds; ///< fewer than those of the sweep: the first ones
    bool cold_build = false;        ///< in a process of its own, too
    bool cold_caches = false;       ///< each query alone, too, after the caches are flushed
    std::vector<std::string> instruction_sets{""}; ///< that each cell is held to; "": to none
};

/// A sweep file, whose blocks hold no key that none of their tasks takes.
struct Config {
    unsigned rounds = 15;
    double min_time_ms = 200; ///< wanted time of one sample
    double delta = 0.05;      ///< times within +-delta are "the same"
    std::uint64_t seed = 1;
    unsigned inputs = 1;              ///< rounds take turns at the seeds from `seed` on, so many
    std::vector<unsigned> threads{1}; ///< of blocks that name none
    std::vector<Block> blocks;
};

/// Throws BadInput naming file, line, key and, for a misspelt key or name, the nearest known one.
Config parse_config(std::string_view text, const std::string& file);

} // namespace boxwood::bench
