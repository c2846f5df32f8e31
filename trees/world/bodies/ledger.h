#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

/// One stage of the plan of a world.
struct PlannedStage {
    std::string name;
    bool is_required = false; ///< what is not is never run: no call, no memory
    std::string why;          ///< required, or not: one clause of plain English
};

/// What one stage did since the ledger was cleared.
struct LedgerRow {
    std::string stage; ///< as PlannedStage::name
    std::uint64_t calls = 0;
    std::uint64_t items = 0; ///< bodies, pairs or trees: what the stage handles
    double ns = 0;           ///< where it is timed
    std::size_t bytes = 0;   ///< that the stage holds now
};

} // namespace boxwood
