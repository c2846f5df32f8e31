#include "trees/world/bodies/ledger.h"

#include <algorithm>
#include <stdexcept>

namespace boxwood {

std::size_t Ledger::index_of(std::string_view stage) const {
    const auto found = std::ranges::find(rows_, stage, &LedgerRow::stage);
    if (found == rows_.end())
        throw std::logic_error("no stage " + std::string(stage) + " in the ledger");
    return static_cast<std::size_t>(found - rows_.begin());
}

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

} // namespace boxwood
