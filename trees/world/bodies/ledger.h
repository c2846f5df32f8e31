#pragma once

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

/// One stage of a plan.
struct PlannedStage {
    std::string name;
    bool is_required = false; ///< by what is asked; what is not need never run
    std::string why;          ///< required, or not: one clause of plain English
};

/// What one stage did since the start of the ledger.
struct LedgerRow {
    std::string stage; ///< as PlannedStage::name
    bool is_required = false;
    std::uint64_t calls = 0;
    std::uint64_t items = 0; ///< bodies, pairs, trees, queries: what the stage handles
    double ns = 0;           ///< where it is timed
    /// Memory of the host that the stage holds now; of a crossing, what crossed since the start.
    std::uint64_t bytes = 0;

    /// Of what goes to a device or comes from one.
    bool is_crossing() const { return stage == "upload" || stage == "download"; }
};

/// Every stage of a plan in its order; those that do not run stay at zero.
class Ledger {
  public:
    /// plan: of PlannedStage, or what derives from it.
    template <std::ranges::input_range Plan> explicit Ledger(const Plan& plan) {
        for (const PlannedStage& stage : plan)
            rows_.push_back({.stage = stage.name, .is_required = stage.is_required});
    }

    std::span<const LedgerRow> rows() const { return rows_; }
    /// Throw std::logic_error for a stage that is not in the plan.
    const LedgerRow& row(std::string_view stage) const { return rows_[index_of(stage)]; }
    std::size_t index_of(std::string_view stage) const;
    double total_ns() const;

    void add(std::size_t row, std::uint64_t calls, std::uint64_t items, double ns) {
        rows_[row].calls += calls;
        rows_[row].items += items;
        rows_[row].ns += ns;
    }
    void set_bytes(std::size_t row, std::uint64_t bytes) { rows_[row].bytes = bytes; }
    /// Of calls, items and times alone.
    void clear();

  private:
    std::vector<LedgerRow> rows_;
};

} // namespace boxwood
