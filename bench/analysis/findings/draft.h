#pragma once

#include "bench/analysis/index.h"
#include "bench/analysis/times.h"
#include "bench/analysis/wording.h"

#include <cstdint>
#include <string>
#include <vector>

namespace boxwood::bench {

/// A finding before the order is known. The question of one about a scene is put together last, of
/// `question`, `how` and `where`.
struct Draft {
    results::Finding finding;
    Outcome outcome = Outcome::open;
    double ratio = 1;     ///< the lower, the worse for us
    std::string question; ///< "nearest hit, primary rays"
    std::string how;      ///< class and threads: ", packets, 2 threads"
    std::string where;    ///< "sphere mesh 10k"
    std::uint64_t n_items = 0;
};
/// Of a row about this scene: what is asked where.
void describe(Draft& draft, const Index& index, const results::Cell& cell);

std::vector<Draft> race_findings(const Index& index, const MedianIndex& medians);
std::vector<Draft> kernel_findings(const Index& index);
std::vector<Draft> scene_findings(const Index& index, const MedianIndex& medians);
std::vector<Draft> device_findings(const Index& index);

} // namespace boxwood::bench
