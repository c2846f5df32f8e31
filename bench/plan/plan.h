#pragma once

#include "bench/tasks/task.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What the command line changes in a sweep file.
struct Overrides {
    std::optional<unsigned> rounds;
    std::vector<unsigned> threads; ///< replaces the threads of every block, if any
    std::optional<std::uint64_t> seed;
    std::string only; ///< regular expression searched for in cell names
    /// The user's own, for blocks of such scenes; rays for those of meshes.
    std::vector<std::filesystem::path> meshes, boxes, motions, rays, robots;

    /// As the command line says it, but for the rounds: {"--threads", "1,2", "--mesh", FILE, ...}.
    std::vector<std::string> arguments() const;
};

/// What tells two scenes of a plan apart.
std::string scene_key(const SceneSpec& spec);

/// One thing to time: a contender that does a task on a scene.
struct PlannedCell {
    std::string name; ///< see cell_name.h
    SceneSpec scene;
    const Task* task = nullptr;
    ContenderEntry contender;
    std::string executor;
    unsigned threads = 1;
    std::optional<unsigned> rounds; ///< only in the first so many of the sweep's
    std::string isa{};              ///< Job::isa
    bool cold_build = false;        ///< whether a first build in a fresh process is timed, too
    bool cold_caches = false;       ///< whether each query is timed with cold caches, too

    bool is_in(unsigned round) const { return !rounds || round < *rounds; }
};

/// A sweep. Two sweeps with one hash measure the same cells in the same way, so that rounds of one
/// can stand beside rounds of the other; the number of rounds is not part of it.
struct Plan {
    unsigned rounds = 0;
    double min_time_ms = 0, delta = 0;
    std::uint64_t seed = 1;
    unsigned inputs = 1; ///< see running/inputs.h
    std::vector<PlannedCell> cells;
    std::string sweep_hash;  ///< 32 hex digits
    std::string config_text; ///< the sweep file as read
};

/// Throws BadInput for what parse_config refuses, a bad --only, a bad file of the user's, two
/// different cells of one name, and a plan without cells.
Plan make_plan(const std::string& config_text, const std::string& config_file,
               const Overrides& overrides);

/// XXH3 of what is measured: the cells, how long, and the content of the files (0: none).
std::string sweep_hash_of(const Plan& plan, std::uint64_t files_hash);

/// The order of a round's timings: a permutation of [0, count) that depends on seed and round
/// alone.
std::vector<std::size_t> shuffled_order(std::size_t count, std::uint64_t order_seed);
std::uint64_t order_seed_of(std::uint64_t seed, unsigned round);

} // namespace boxwood::bench
