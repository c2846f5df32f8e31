#include "bench/analysis/analyse.h"

#include "bench/analysis/comparisons.h"
#include "bench/analysis/figures/devices.h"
#include "bench/analysis/figures/drift.h"
#include "bench/analysis/figures/frames.h"
#include "bench/analysis/figures/kernel_rows.h"
#include "bench/analysis/figures/stage_costs.h"
#include "bench/analysis/figures/work.h"
#include "bench/analysis/findings.h"
#include "bench/analysis/health.h"
#include "bench/analysis/kernel_costs.h"
#include "bench/analysis/promises.h"
#include "bench/analysis/size_scaling.h"
#include "bench/analysis/status.h"
#include "bench/analysis/times.h"
#include "bench/analysis/trade_offs.h"

namespace boxwood::bench {

void analyse(results::Results& results, double delta) {
    set_statuses(results);
    set_broken_promises(results);
    const Times times(results);
    const NoiseFloors floors(results, times);
    results.medians = medians_of(results, times);
    results.compare = comparisons_of(results, times, delta);
    results.size_scaling = size_scaling_of(results, times);
    results.break_even = trade_offs_of(results, floors.highest().value_or(0));
    set_tree_fronts(results, floors.highest().value_or(0));
    set_kernel_rows(results);
    results.kernel_costs = kernel_costs_of(results);
    results.kernel_conditions = kernel_conditions_of(results);
    results.escalations = escalations_of(results);
    results.frame_medians = frame_medians_of(results);
    results.frame_stats = frame_stats_of(results);
    results.stage_costs = stage_costs_of(results);
    results.effect_costs = effect_costs_of(results);
    results.query_kernels = query_kernels_of(results);
    results.work = work_of(results);
    set_off_medians(results);
    results.drift = drift_of(results);
    set_device_gains(results, times);
    results.health = {health_of(results, floors, delta)};
    results.topics = topics();
    results.findings = findings_of(results);
}

double delta_of(std::span<const results::Results> parts) {
    for (const results::Results& part : parts)
        if (!part.health.empty())
            return part.health.front().delta;
    return default_delta;
}

} // namespace boxwood::bench
