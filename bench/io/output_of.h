#pragma once

#include <string>

namespace boxwood::bench {

/// What a command of the shell prints; empty if it cannot be started.
std::string output_of(const std::string& command);

} // namespace boxwood::bench
