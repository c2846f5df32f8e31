#pragma once

#include "bench/tasks/one_by_one.h"
#include "bench/peers/capability.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// The registry row of a peer's function over all cases of a hard-case family, on one thread.
/// `Input`, in the peer's own types, is made of one case of type `Case`; `answers` is the list of
/// Answers that it fills.
template <class Case, class Input, auto function, auto answers>
ContenderEntry each_case(Ask ask, std::string library, std::string name, std::string precision,
                         std::string summary, std::string notes) {
    ContenderEntry e;
    e.name = library + "." + std::move(name);
    e.library = std::move(library);
    e.summary = std::move(summary);
    e.notes = std::move(notes);
    e.precision = std::move(precision);
    e.kernel = e.name;
    e.unsupported = [ask](const Job& job) -> Unsupported {
        if (job.task != ask)
            return "answers " + std::string(to_string(ask)) + " only";
        return not_serial(job);
    };
    e.make = [](const Job& job) {
        std::vector<Input> inputs;
        if constexpr (std::is_same_v<Case, MotionCase>)
            for (const MotionCase& c : std::get<MotionCases>(job.scene->cases).motions)
                inputs.emplace_back(c);
        else
            for (const Case& c : std::get<std::vector<Case>>(job.scene->cases))
                inputs.emplace_back(c);
        return one_by_one<answers>(std::move(inputs), [](Input& input) { return function(input); });
    };
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
