#include "bench/analysis/findings/draft.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <utility>

namespace boxwood::bench {

/// For each scene and task the size from which on a device wins, and how much at the largest.
std::vector<Draft> device_findings(const Index& index) {
    std::vector<Draft> drafts;
    for (const results::DeviceBreakEven& row : index.results().device_break_even) {
        Draft draft;
        draft.finding.topic = results::Topic::device;
        draft.finding.ours = row.cell_device;
        draft.finding.rival = row.cell_cpu;
        draft.finding.together = row.words;
        for (const results::Comparison& other : index.results().compare)
            if (other.family == results::Family::devices && other.cell_a == row.cell_cpu &&
                other.cell_b == row.cell_device) {
                const std::uint32_t threads = index.cell(row.cell_cpu).threads;
                draft.finding.alone = outcome_text(
                    other, fmt::format("{} thread{}", threads, threads == 1 ? "" : "s"));
                draft.finding.certainty = certainty_text(other, 1 / other.ci_hi, 1 / other.ci_lo);
                draft.outcome = outcome_of(other);
                draft.ratio = 1 / other.ratio;
            }
        const results::Cell& cell = index.cell(row.cell_device);
        describe(draft, index, cell);
        draft.where = spaced(index.scene(cell.scene_id).name);
        drafts.push_back(std::move(draft));
    }
    return drafts;
}

} // namespace boxwood::bench
