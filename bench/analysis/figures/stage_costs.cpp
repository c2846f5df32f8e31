#include "bench/analysis/figures/stage_costs.h"

#include "bench/analysis/statistics.h"
#include "bench/analysis/times.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace boxwood::bench {

using results::EffectCost;
using results::EffectRow;
using results::Results;
using results::StageCost;

std::vector<StageCost> stage_costs_of(const Results& results) {
    struct Stage {
        const EffectRow* first;
        std::vector<double> ns; ///< of all frames, by round
    };
    std::map<std::uint32_t, std::vector<Stage>> plans; // by cell
    for (const EffectRow& row : results.effects) {
        std::vector<Stage>& plan = plans[row.cell_id];
        auto stage =
            std::ranges::find(plan, row.stage, [](const Stage& s) { return s.first->stage; });
        if (stage == plan.end())
            stage = plan.insert(plan.end(), {&row, {}});
        if (!std::isnan(row.total_ns))
            stage->ns.push_back(row.total_ns);
    }
    std::map<std::uint32_t, double> n_frames; // of scenes
    for (const results::SceneRow& scene : results.scenes)
        n_frames[scene.scene_id] = static_cast<double>(std::max<std::uint64_t>(1, scene.n_frames));
    std::vector<StageCost> all;
    for (const results::Cell& cell : results.cells) {
        const std::size_t start = all.size();
        double until = 0;
        for (const Stage& stage : plans[cell.cell_id]) {
            const EffectRow& row = *stage.first;
            StageCost cost{cell.cell_id, row.stage, row.effect, row.required,
                           row.calls,    row.items, row.bytes};
            if (row.calls > 0 && !stage.ns.empty())
                cost.ns = median_interval(stage.ns).mid / n_frames[cell.scene_id];
            cost.until_ns = until += cost.ns;
            all.push_back(std::move(cost));
        }
        for (std::size_t i = start; i < all.size() && until > 0; ++i)
            all[i].share = all[i].ns / until;
    }
    return all;
}

std::vector<EffectCost> effect_costs_of(const Results& results) {
    std::map<std::uint32_t, std::string> by_variant, stages; // the latter by cell
    for (const results::Variant& variant : results.variants)
        by_variant[variant.variant_id] = variant.stages;
    for (const results::Cell& cell : results.cells)
        stages[cell.cell_id] = by_variant[cell.variant_id];
    const MedianIndex medians(results);
    constexpr auto frame = results::Phase::update_and_query;
    std::vector<EffectCost> all;
    for (const results::Comparison& row : results.compare) {
        if (row.family != results::Family::stages || row.phase != frame || std::isnan(row.ratio))
            continue;
        EffectCost cost;
        cost.cell_with = row.cell_b;
        cost.cell_without = row.cell_a;
        cost.what = stages[row.cell_b] == results::all_stages ? "all stages" : stages[row.cell_a];
        cost.with_ns = medians.ns(row.cell_b, frame);
        cost.without_ns = medians.ns(row.cell_a, frame);
        cost.ratio = row.ratio;
        cost.ci_lo = row.ci_lo;
        cost.ci_hi = row.ci_hi;
        cost.extra_ns = cost.with_ns * (1 - 1 / row.ratio);
        all.push_back(std::move(cost));
    }
    return all;
}

} // namespace boxwood::bench
