#pragma once

#include "bench/tasks/detail/one_by_one.h"

#include "kernels/decision.h"
#include "kernels/triangle_distance/distance_kernel.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// A peer's function over all cases of a family of hard cases. `Input`, in the peer's own types, is
/// made of one case of type `Case`.
template <class Case, class Input, auto function>
std::unique_ptr<Contender> over_cases(const Job& job) {
    std::vector<Input> inputs;
    if constexpr (std::is_same_v<Case, MotionCase>)
        for (const Case& c : std::get<MotionCases>(job.scene->cases).motions)
            inputs.emplace_back(c);
    else
        for (const Case& c : std::get<std::vector<Case>>(job.scene->cases))
            inputs.emplace_back(c);
    return one_by_one(std::move(inputs), [](Input& input) { return function(input); });
}

/// Its registry row, on one thread.
template <class Case, class Input, auto function>
ContenderEntry each_case(std::string task, std::string library, std::string name,
                         std::string precision, std::string summary, std::string notes) {
    ContenderEntry e;
    e.name = library + "." + std::move(name);
    e.library = std::move(library);
    e.summary = std::move(summary);
    e.notes = std::move(notes);
    e.precision = std::move(precision);
    e.kernel = e.name;
    e.runs_on = RunsOn::one_thread;
    e.answers = {{std::move(task), over_cases<Case, Input, function>}};
    return e;
}

inline Decision yes_or_no(bool yes) { return {yes ? Answer::yes : Answer::no, 0}; }

/// A distance without a bound, and without witnesses, which nobody judges.
inline Distance plain_distance(double d) {
    Distance result;
    result.distance = result.lo = result.hi = d;
    return result;
}

} // namespace boxwood::bench
