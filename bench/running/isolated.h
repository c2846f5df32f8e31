#pragma once

#include "bench/tasks/contender.h"

#include <functional>
#include <string>

namespace boxwood::bench {

/// What came of some work: answers and a time, or why there are none.
struct Outcome {
    Answers answers;
    double ns = 0;
    std::string failure; ///< "crashed: signal 11 (...)", "threw: ...", "hung: ..."; else empty
};

/// Runs `work` (which fills answers and ns) in a fork of this process, so that it may crash, hang
/// or leave modes and memory changed. What it says on stderr is lost. Only the calling thread lives
/// in the fork. Throws std::system_error if no process can be made.
Outcome isolated(const std::function<void(Outcome&)>& work, int timeout_s = 60);

} // namespace boxwood::bench
