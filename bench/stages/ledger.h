#pragma once

#include "bench/stages/plan_stages.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What one stage did since the start of the ledger.
struct LedgerRow {
    std::string stage, effect; ///< as PlannedStage
    bool is_required = false;  ///< by the scene
    std::uint64_t calls = 0;
    std::uint64_t items =
        0; ///< bodies, pairs, vertices, triangles, queries: what the stage handles
    double ns = 0;
    /// Memory of the host that the stage holds now; of a crossing, what crossed since the start.
    std::uint64_t bytes = 0;

    /// Of what goes to a device or comes from one.
    bool is_crossing() const { return stage == "upload" || stage == "download"; }
};

/// Every stage of the plan in its order; those that do not run stay at zero.
class Ledger {
  public:
    explicit Ledger(std::span<const PlannedStage> plan);

    std::span<const LedgerRow> rows() const { return rows_; }
    const LedgerRow& row(std::string_view stage) const;
    double total_ns() const;

    void add(std::size_t row, std::size_t calls, std::size_t items, double ns) {
        rows_[row].calls += calls;
        rows_[row].items += items;
        rows_[row].ns += ns;
    }
    void set_bytes(std::size_t row, std::uint64_t bytes) { rows_[row].bytes = bytes; }
    /// Of calls, items and times alone.
    void clear();
    std::size_t index_of(std::string_view stage) const;

  private:
    std::vector<LedgerRow> rows_;
};

} // namespace boxwood::bench
