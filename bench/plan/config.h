#pragma once

#include "bench/tasks/contender.h"
#include "scenes/moving/scene_file.h"
#include "trees/builder.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// A builder as a sweep file names it: `"median"` or `{name = "binned_sah", bins = 16}`.
struct BuilderChoice {
    std::string name;
    Settings settings;
};

/// One `[[cells]]` block: the cross product of its lists.
struct Block {
    std::string place; ///< "FILE:LINE", for messages
    /// Generators; of moving asks moving scenes, too: built in, or paths of files; of kernel asks
    /// families, panels, or "all"
    std::vector<std::string> scenes;
    std::vector<std::size_t> n{1000}; ///< empty: each moving scene's own
    std::vector<double> overlaps{10};
    std::vector<std::string> rays; ///< kinds of rays; needed by the ray asks alone
    std::size_t n_rays = 10000;
    std::vector<std::string> ray_order{"given"};
    std::size_t n_points = 10000;              ///< points or regions, for their asks
    std::vector<std::string> regions{"boxes"}; ///< kinds of regions, for the ask regions
    std::vector<Ask> tasks;
    /// Of moving asks of generators: each element makes a scene by the effects that it lays on all
    /// boxes.
    std::vector<std::vector<EffectChoice>> effects;
    std::optional<std::size_t> n_frames; ///< else the scene's own
    std::vector<std::string> stages;     ///< of scene_queries: required, everything
    std::vector<std::string> without;    ///< of scene_queries: effects, or "each"
    std::vector<BuilderChoice> builders;
    std::vector<BuilderChoice> updates; ///< policies, for moving_pairs
    std::vector<std::string> layouts{"wide8"};
    std::optional<std::vector<std::string>> kernels; ///< else the ask's default; see kernels_of
    std::vector<int> k, scales; ///< of hard-case families; empty: their default, 0. For the ask
                                ///< nearest k is the number of neighbours; empty: 1
    std::vector<std::string> executors; ///< empty: serial for one thread, tbb for more
    std::vector<unsigned> threads;
    std::vector<std::string> peers; ///< "all", libraries, or contenders
    std::optional<unsigned> rounds; ///< fewer than those of the sweep: the first ones
};

/// The kernels that a block times for one of its asks: words of the ask's registry, "all"
/// resolved. By default watertight for rays, else every one.
std::vector<std::string> kernels_of(const Block& block, Ask ask);

/// A sweep file, every word of it known to a registry.
struct Config {
    unsigned rounds = 15;
    double min_time_ms = 200; ///< wanted time of one sample
    double delta = 0.05;      ///< times within +-delta are "the same"
    std::uint64_t seed = 1;
    std::vector<Block> blocks;
};

/// Throws BadInput naming file, line, key and, for a misspelt key or word, the nearest known one.
Config parse_config(std::string_view text, const std::string& file);

} // namespace boxwood::bench
