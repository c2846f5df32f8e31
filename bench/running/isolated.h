#pragma once

#include "bench/tasks/answers.h"

#include <functional>
#include <string>

namespace boxwood::bench {

/// What came of some work beside its answers: a time, or why there are none.
struct Outcome {
    double ns = 0;
    std::string failure; ///< "crashed: signal 11 (...)", "threw: ...", "hung: ..."; else empty
};

/// Runs `work` (which fills the answers and gives the time) in a fork of this process, so that it
/// may crash, hang or leave modes and memory changed. What it says on stderr is lost. Only the
/// calling thread lives in the fork. Throws std::system_error if no process can be made.
Outcome isolated(Answers& answers, const std::function<double(Answers&)>& work, int timeout_s = 60);

} // namespace boxwood::bench
