#pragma once

#include "results/results.h"

#include <vector>

namespace boxwood::bench {

/// Every frame of every cell that was timed frame by frame, ordered by cell, then frame: medians
/// over the rounds, which take out what disturbed one round, and not what one frame costs. A
/// frame's query is held against that of the same frame by the structure of ours that is rebuilt
/// for every frame of the job (scene, task, threads), else against the cell's own first frame.
/// Needs Cell::status.
std::vector<results::FrameMedian> frame_medians_of(const results::Results& results);

/// Percentiles over the frames of each cell. Needs Cell::status and /frame_medians.
std::vector<results::FrameStats> frame_stats_of(const results::Results& results);

} // namespace boxwood::bench
