#pragma once

#include "scenes/text/bad_input.h"

#include <stdexcept>

namespace boxwood::bench {

using boxwood::BadInput; // exit code 2

/// Ctrl-C: the message says what was done by then. Exit code 130.
class Interrupted : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

inline constexpr int exit_success = 0;
inline constexpr int exit_failed = 1;      ///< a check or a promise failed
inline constexpr int exit_bad_input = 2;   ///< also any other exception that reaches main
inline constexpr int exit_cannot_tell = 3; ///< compare alone
inline constexpr int exit_interrupted = 130;

} // namespace boxwood::bench
