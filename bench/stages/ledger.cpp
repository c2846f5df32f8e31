#include "bench/stages/ledger.h"

#include <algorithm>
#include <stdexcept>

namespace boxwood::bench {

Ledger::Ledger(std::span<const PlannedStage> plan) {
    for (const PlannedStage& stage : plan)
        rows_.push_back(
            {.stage = stage.name, .effect = stage.effect, .is_required = stage.is_required});
}

std::size_t Ledger::index_of(std::string_view stage) const {
    const auto found = std::ranges::find(rows_, stage, &LedgerRow::stage);
    if (found == rows_.end())
        throw std::logic_error("no stage " + std::string(stage) + " in the ledger");
    return static_cast<std::size_t>(found - rows_.begin());
}

const LedgerRow& Ledger::row(std::string_view stage) const { return rows_[index_of(stage)]; }

double Ledger::total_ns() const {
    double sum = 0;
    for (const LedgerRow& row : rows_)
        sum += row.ns;
    return sum;
}

void Ledger::clear() {
    for (LedgerRow& row : rows_) {
        row.calls = row.items = 0;
        row.ns = 0;
    }
}

} // namespace boxwood::bench
