#pragma once

#include "results/results.h"

namespace boxwood::results::detail {

/// Throws std::runtime_error naming the column for an id that stands twice in its table, and for
/// one that names no row.
void require_valid_ids(const Results& results);

} // namespace boxwood::results::detail
