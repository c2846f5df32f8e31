#pragma once

#include "results/results.h"

#include <string>

namespace boxwood::bench {

/// The machine, the compiler and the libraries as they are now; env_hash covers what must be equal
/// for two shards to belong together (not load, not time). The memory bandwidth is measured (about
/// 0.2 s) only if asked for.
results::Env environment(bool measure_bandwidth);

/// The instruction set that Highway picks on this machine ("AVX3_ZEN4", ...).
std::string isa_used();

/// What was given to the compiler, and the raw output of lscpu (empty where it is missing).
std::string cmake_cache_text();
std::string lscpu_text();

} // namespace boxwood::bench
