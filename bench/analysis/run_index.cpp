#include "bench/analysis/run_index.h"

#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace boxwood::bench {

RunIndex::RunIndex(const results::Results& results)
    : results_(results), times_(results), standing_of_(standings(results)) {
    for (const auto& scene : results.scenes)
        scenes_[scene.scene_id] = &scene;
    for (const auto& variant : results.variants)
        variants_[variant.variant_id] = &variant;
    for (const CellStats& stats : cell_stats(results))
        median_of_[{stats.cell_id, stats.phase}] = stats.median_ns;
}

double RunIndex::median_ns(const results::Cell& cell, const std::string& phase) const {
    const auto found = median_of_.find({cell.cell_id, phase});
    return found == median_of_.end() ? std::numeric_limits<double>::infinity() : found->second;
}

double RunIndex::median_ns(const results::Cell& cell,
                           std::initializer_list<const char*> phases) const {
    double sum = 0;
    for (const char* phase : phases)
        sum += median_ns(cell, phase);
    return sum;
}

std::string interval_text(double ratio, double lo, double hi) {
    if (std::isnan(lo) || std::isnan(hi))
        return ratio_text(ratio);
    return fmt::format("{} [{}, {}]", ratio_text(ratio), ratio_text(lo), ratio_text(hi));
}

std::string verdict_text(const std::string& verdict) {
    return verdict == "cannot_tell" ? "can't tell"
           : verdict == "wrong"     ? "not ranked: a wrong answer"
                                    : verdict;
}

} // namespace boxwood::bench
