#pragma once

#include "bench/analysis/compare_files.h"
#include "results/results.h"

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What two files say of one counter of one cell of ours.
struct CountRow {
    enum class Change : std::uint8_t { same, fewer, more };
    std::string cell, counter;
    std::uint64_t base = 0, head = 0;
    Change change = Change::same;
    bool is_expected = false;
    Gate gate = Gate::passes;

    /// Head over base; NaN where the base has none.
    double ratio() const;
};
struct CountComparison {
    std::vector<CountRow> rows;
    std::vector<Lost> lost;             ///< what the base has and the head has not
    std::vector<std::string> only_head; ///< cells
    std::set<std::string> newly_wrong;  ///< cells: right in the base, wrong in the head
    std::string base_by, head_by;       ///< what instructions depend on beside our code
    bool has_instructions = false;      ///< in the base
    bool is_sealed = false;             ///< both files are as they were written
    Gate gate = Gate::open;             ///< of all
};
struct CountOptions {
    double more = 0.01; ///< instructions and bytes may be more by so much
    std::function<bool(const std::string& cell)> wanted{};               ///< else all
    std::function<bool(const std::string& cell_and_counter)> expected{}; ///< else none
};
/// Cells of ours that are supported are matched by name. A row fails if there is more of
/// its counter in the head, of instructions and bytes more by more than the limit, unless that is
/// expected; fewer passes. Instructions that something else counted (`base_by`) are open, as is all
/// if something is lost or nothing counted in both. Needs Cell::status in both.
CountComparison compare_counts(const results::Results& base, const results::Results& head,
                               const CountOptions& options = {});

} // namespace boxwood::bench
