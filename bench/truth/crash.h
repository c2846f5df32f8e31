#pragma once

#include "results/results.h"

#include <string>
#include <string_view>

/// How a file says that a contender brought its process down: by the witness of a wrong answer.
namespace boxwood::bench {

inline constexpr std::string_view crash_prefix = "crashed: ";

inline std::string crash_text(std::string_view cause) { return std::string(crash_prefix) += cause; }
inline bool has_crashed(const results::Check& check) {
    return check.status == results::Status::wrong && check.witness.starts_with(crash_prefix);
}

} // namespace boxwood::bench
