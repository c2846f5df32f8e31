#pragma once

#include "results/results.h"

#include <optional>

namespace boxwood::bench {

/// Whether a run can be believed, in numbers and in words. Needs Cell::status and
/// KernelRow::is_broken.
results::Health health_of(const results::Results& results, std::optional<double> floor,
                          double delta);

} // namespace boxwood::bench
