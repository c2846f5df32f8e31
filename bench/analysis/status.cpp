#include "bench/analysis/status.h"

#include <algorithm>
#include <map>

namespace boxwood::bench {

void set_statuses(results::Results& results) {
    using results::Status;
    std::map<std::uint32_t, Status> worst; // the enum's order is from right to wrong
    for (const results::Check& check : results.checks)
        worst[check.cell_id] = std::max(worst[check.cell_id], check.status);
    for (const results::Sample& sample : results.samples)
        if (sample.flags & results::wrong_answer)
            worst[sample.cell_id] = Status::wrong;
    for (results::Cell& cell : results.cells) {
        const auto found = worst.find(cell.cell_id);
        cell.status = found == worst.end() ? Status::unchecked : found->second;
    }
}

} // namespace boxwood::bench
