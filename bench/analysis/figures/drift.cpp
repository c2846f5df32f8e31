#include "bench/analysis/figures/drift.h"

#include "bench/analysis/statistics.h"
#include "bench/analysis/times.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace boxwood::bench {

using results::Sample;

void set_off_medians(results::Results& results) {
    const MedianIndex medians(results);
    for (Sample& sample : results.samples)
        sample.off_median = sample.wall_ns > 0
                                ? sample.wall_ns / medians.ns(sample.cell_id, sample.phase) - 1
                                : results::missing;
}

std::vector<results::Drift> drift_of(const results::Results& results) {
    std::map<std::uint32_t, std::vector<double>> off; // by shard
    std::map<std::uint32_t, std::uint64_t> disturbed;
    for (const Sample& sample : results.samples) {
        if (sample.phase != results::Phase::query || (sample.flags & results::aa_twin) != 0 ||
            !std::isfinite(sample.off_median))
            continue;
        off[sample.shard_id].push_back(sample.off_median);
        disturbed[sample.shard_id] +=
            (sample.flags & (results::disturbed_steal | results::disturbed_switches)) != 0;
    }
    std::vector<results::Drift> all;
    for (const results::Shard& shard : results.shards)
        if (const auto found = off.find(shard.shard_id); found != off.end())
            all.push_back({shard.shard_id, found->second.size(), disturbed[shard.shard_id],
                           median_interval(found->second).mid});
    const auto farthest =
        std::ranges::max_element(all, {}, [](const auto& row) { return std::abs(row.off_median); });
    if (farthest != all.end())
        farthest->is_farthest = 1;
    return all;
}

} // namespace boxwood::bench
