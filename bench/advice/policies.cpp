#include "bench/advice/policies.h"

#include "bench/analysis/index.h"
#include "bench/analysis/status.h"
#include "bench/analysis/times.h"
#include "bench/analysis/wording.h"
#include "bench/io/bad_input.h"
#include "bench/io/json.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {

using results::Phase;

PolicyAdvice advise_of_policies(const results::Results& results) {
    const Index index(results);
    const Times times(results);
    const NoiseFloors floors(results, times);
    PolicyAdvice advice;
    std::vector<const results::Cell*> cells;
    for (const results::Cell& cell : results.cells) {
        const Times::Rounds* const rounds = times.rounds(cell.cell_id, Phase::update_and_query);
        if (!is_right(cell.status) || !rounds)
            continue;
        const results::Variant& variant = index.variant(cell);
        advice.policies.push_back(
            {variant.is_peer ? peer_text(variant) : variant.name.substr(0, variant.name.find('.')),
             variant.is_peer != 0,
             median_interval(medians_by_round(*rounds)),
             {},
             false});
        cells.push_back(&cell);
        advice.scene = index.scene(cell.scene_id).human_name;
    }
    const results::Cell* best = nullptr;
    double least = 0;
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (const Policy& policy = advice.policies[i];
            !policy.is_peer && (!best || policy.frame.mid < least)) {
            best = cells[i];
            least = policy.frame.mid;
        }
    if (!best)
        throw BadInput("choose: no policy of ours was timed and answered right");
    std::vector<Claim> claims;
    for (const results::Cell* cell : cells)
        claims.push_back(
            {times.log_ratios(best->cell_id, cell->cell_id, Phase::update_and_query),
             floors.of(*best, *cell, Phase::update_and_query).value_or(default_delta)});
    const std::vector<Ruling> rulings = decide(claims, default_delta);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        advice.policies[i].over_best = rulings[i].ratio;
        advice.policies[i].is_as_good =
            cells[i] == best || (rulings[i].verdict != results::Verdict::slower &&
                                 rulings[i].verdict != results::Verdict::faster);
    }
    std::ranges::sort(advice.policies, {}, [](const Policy& p) { return p.frame.mid; });
    advice.best = static_cast<std::size_t>(
        std::ranges::find_if(advice.policies, [](const Policy& p) { return !p.is_peer; }) -
        advice.policies.begin());
    return advice;
}

std::string policies_text(const PolicyAdvice& advice) {
    const Policy& best = advice.policies[advice.best];
    std::string text = fmt::format("{}, the pairs of each frame\n\nUse {}: {} a frame.",
                                   advice.scene, best.name, time_text(best.frame.mid));
    std::string as_good;
    const Policy* rival = nullptr;
    for (const Policy& policy : advice.policies) {
        if (policy.is_peer && !rival)
            rival = &policy;
        if (!policy.is_peer && policy.is_as_good && &policy != &best)
            as_good += (as_good.empty() ? "" : ", ") + policy.name;
    }
    text += as_good.empty() ? "\n"
                            : fmt::format(" Not told apart from it beyond noise: {}.\n", as_good);
    if (rival)
        text += fmt::format(
            "{} would take {} as long{}.\n", rival->name,
            interval_text(rival->over_best.ratio, rival->over_best.ci_lo, rival->over_best.ci_hi),
            rival->is_as_good ? ", which is not told apart from it beyond noise" : "");
    text += fmt::format("\nC++:\n    auto updater = boxwood::find_update(\"{}\").make({{}});\n"
                        "    updater->start(boxes, boxwood::serial());\n"
                        "    updater->update(boxes, moved, boxwood::serial()); // each frame\n"
                        "    updater->self_pairs(boxwood::serial(), sink);\n"
                        "Python (its one policy refits, and builds again where that got loose):\n"
                        "    bvh = boxwood.Bvh(boxes)\n    bvh.update(boxes)\n\n",
                        best.name);
    for (const Policy& policy : advice.policies)
        text += fmt::format(
            "{:<40} {:>10}  {}\n", policy.name, time_text(policy.frame.mid),
            interval_text(policy.over_best.ratio, policy.over_best.ci_lo, policy.over_best.ci_hi));
    return text;
}

std::string policies_json(const PolicyAdvice& advice) {
    std::string rows;
    for (const Policy& p : advice.policies)
        rows += fmt::format(
            R"({}{{"name":{},"is_peer":{},"frame_ns":{},"over_best":{},"lo":{},"hi":{},)"
            R"("is_as_good":{}}})",
            rows.empty() ? "" : ",", json_string(p.name), p.is_peer, json_number(p.frame.mid),
            json_number(p.over_best.ratio), json_number(p.over_best.ci_lo),
            json_number(p.over_best.ci_hi), p.is_as_good);
    return fmt::format(R"({{"task":"moving_pairs","scene":{},"best":{},"policies":[{}]}})"
                       "\n",
                       json_string(advice.scene), json_string(advice.policies[advice.best].name),
                       rows);
}

} // namespace boxwood::bench
