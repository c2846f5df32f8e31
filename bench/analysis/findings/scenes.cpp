#include "bench/analysis/findings/draft.h"
#include "bench/analysis/status.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <utility>

namespace boxwood::bench {

/// For each moving scene what a frame takes, and what all stages would.
std::vector<Draft> scene_findings(const Index& index, const MedianIndex& medians) {
    std::vector<Draft> drafts;
    for (const results::Cell& cell : index.results().cells) {
        if (!is_right(cell.status) || index.stages(cell) != results::required_stages)
            continue;
        Draft draft;
        results::Finding& row = draft.finding;
        row.topic = results::Topic::scene;
        row.ours = cell.cell_id;
        constexpr results::Phase of_frame = results::Phase::update_and_query;
        const double frame = medians.ns(cell.cell_id, of_frame);
        row.together = time_text(frame) + " a frame";
        for (const results::Comparison& other : index.results().compare)
            if (other.cell_a == cell.cell_id && other.family == results::Family::stages &&
                other.phase == of_frame) {
                row.alone = ratio_text(other.ratio) + "x the time";
                row.certainty = certainty_text(other, other.ci_lo, other.ci_hi);
                row.rival = other.cell_b;
            }
        describe(draft, index, cell);
        if (is_device(cell))
            draft.how += ", " + cell.executor;
        draft.outcome = Outcome::wins;
        draft.ratio = 1e9 / frame; // the slowest first
        drafts.push_back(std::move(draft));
    }
    return drafts;
}

} // namespace boxwood::bench
