#pragma once

#include "bench/replay/recorded_program.h"

#include <cstddef>
#include <cstdint>

namespace boxwood::bench {

struct MadeProgramOptions {
    std::size_t bodies = 10'000; ///< boxes spread evenly, about ten overlaps each
    double moved = 1;            ///< the share that drifts by up to a tenth of its size each frame
    unsigned frames = 20;
    std::uint64_t seed = 1;
};

/// For those who have no recording: bodies are registered at once; in each frame some move, the
/// moved ones are reported to the manager, or all if all do, and it shows the pairs.
RecordedProgram made_program(const MadeProgramOptions& options);

} // namespace boxwood::bench
