#pragma once

#include "bench/replay/recorded_program.h"

#include <cstddef>
#include <cstdint>

namespace boxwood::bench {

struct MadeProgramOptions {
    std::size_t bodies = 10'000; ///< boxes spread evenly, about ten overlaps each
    /// If not 0, bodies are no boxes: copies of a mesh of about so many, turned at random, are at
    /// their places. Bounds are cubes of the boxes' mean side.
    std::size_t triangles = 0;
    double moved = 1; ///< the share that drifts by up to a tenth of its size each frame
    unsigned frames = 20;
    std::size_t distances = 0; ///< queries a frame: how near another body is to one
    std::uint64_t seed = 1;
};

/// For those who have no recording: bodies are registered at once; in each frame some move, the
/// moved ones are reported to the manager, or all if all do, it shows the pairs, and finds
/// distances.
RecordedProgram made_program(const MadeProgramOptions& options);

} // namespace boxwood::bench
