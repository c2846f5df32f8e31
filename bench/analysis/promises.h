#pragma once

#include "results/results.h"

#include <cstddef>
#include <string>

/// Whether ours keeps what it promises.
namespace boxwood::bench {

/// Sets KernelRow::is_broken of every row.
void set_broken_promises(results::Results& results);

std::size_t broken_promises(const results::Results& results);

/// The kernels of ours that break their promise, each with its witness, ten at most; a sentence if
/// there are none.
std::string promises_text(const results::Results& results);

/// Whether an answer of ours is wrong, or any contender brought its process down. A kernel without
/// a promise may err on hard cases. Needs Cell::status and KernelRow::is_broken.
bool is_promise_broken(const results::Results& results);

/// Whether a kernel is judged by its promise, and not by each answer.
bool is_judged_by_promise(const results::Results& results, const results::Cell& cell);

} // namespace boxwood::bench
