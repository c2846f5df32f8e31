#pragma once

#include "results/results.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// The machine, the compiler and the libraries as they are now; env_hash covers what must be equal
/// for two shards to belong together (not load, not time). The memory bandwidth is measured (about
/// 0.3 s) only if wanted.
results::Env environment(bool measure_bandwidth);

/// What was given to the compiler, and the raw output of lscpu (empty where it is missing).
std::string cmake_cache_text();
std::string lscpu_text();

/// How this program was built.
std::string_view build_type();
std::string_view sanitizers(); ///< "address,undefined", or empty
std::string_view version();    ///< "0.1.0"
std::string git_commit();      ///< "6a0a155...", with "-dirty" if sources differ, or "unknown"
std::string compiler();        ///< "g++ 12.2.0"

/// Name and version of each library, ours to use and peers alike.
std::vector<std::pair<std::string, std::string>> packages();

/// The same as rows of a result file, for env_id 0.
std::vector<results::Package> package_rows();

/// The control register of SSE arithmetic (0 elsewhere), and whether it sets anything but the
/// IEEE default: rounding to nearest, subnormals kept.
std::uint32_t mxcsr();
bool ieee_arithmetic();

} // namespace boxwood::bench
