#pragma once

#include "trees/executor.h"

#include <algorithm>
#include <cstddef>

namespace boxwood {

/// The range [begin, end) of chunk c when n entries are cut into `chunks` parts of about equal
/// size.
struct ChunkRange {
    ChunkRange(std::size_t n, std::size_t chunks, std::size_t c)
        : begin(n * c / chunks), end(n * (c + 1) / chunks) {}
    std::size_t begin, end;
};

/// Parts for a pass over n entries whose result does not depend on how it is cut: one per thread,
/// and one alone where handing out work would cost more than the pass.
inline std::size_t chunks_for(std::size_t n, const Executor& executor) {
    constexpr std::size_t smallest = 8192;
    return std::clamp<std::size_t>(n / smallest, 1, executor.threads());
}

} // namespace boxwood
