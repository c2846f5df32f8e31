#pragma once

#include "results/results.h"

namespace boxwood::bench {

/// Only these are ranked.
constexpr bool is_right(results::Status status) {
    using enum results::Status;
    return status == exact || status == conservative || status == within_bound;
}

/// Sets Cell::status of every cell: the worst of its checks; wrong if a timed round answered
/// otherwise.
void set_statuses(results::Results& results);

} // namespace boxwood::bench
