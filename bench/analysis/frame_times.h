#pragma once

#include "bench/analysis/run_index.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace boxwood::bench {

/// Update and query of the frames of one cell. Each frame counts by its median over the rounds, so
/// that what stands out is the frame and not a disturbance of one round.
struct FrameStats {
    std::size_t n_frames = 0;
    double p50_ns = unknown, p95_ns = unknown, p99_ns = unknown, worst_ns = unknown;
    double over_1ms = 0, over_16ms = 0; ///< shares of the frames above 1 ms and above 1/60 s
};
std::map<std::uint32_t, FrameStats> frame_stats(const results::Results& results);

/// The frame times of every moving scene: of all that was timed, or in brief of the best of each
/// library, of the policies auto and cached, and of what a scene calls for.
std::string frame_times_text(const RunIndex& index, bool brief);

/// The best of ours against the best peer of each moving scene, by update and query of a frame.
std::string frame_peers_text(const RunIndex& index);

} // namespace boxwood::bench
