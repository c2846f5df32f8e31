#pragma once

#include "bench/tasks/contender.h"
#include "kernels/decision.h"

#include <span>
#include <string_view>

/// Boxwood's kernels as contenders of the kernel asks: every rung of the kernels' registries, the
/// rational ones included, over the cases of a hard-case family.
namespace boxwood::bench {

/// The rungs that answer a kernel ask, in the order of their registries, the rational ones last.
std::span<const KernelInfo> rungs(Ask ask);

/// The contender of a rung: its word is the name. It runs on one thread.
/// Throws std::invalid_argument, with a suggestion, for a word that rungs(ask) does not have.
ContenderEntry rung_contender(Ask ask, std::string_view kernel);

} // namespace boxwood::bench
