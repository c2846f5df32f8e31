#pragma once

#include "bench/peers/capability.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// A peer's function over all cases of a hard-case family, on one thread. `Input` is a case in the
/// peer's own types, made before timing; `answers` is the list of Answers that it fills.
template <class Input, auto function, auto answers> class EachCase final : public Contender {
  public:
    explicit EachCase(std::vector<Input> inputs) : inputs_(std::move(inputs)) {}

    void build() override {}

    void query(Answers& all) override {
        auto& out = all.*answers;
        out.resize(inputs_.size());
        for (std::size_t i = 0; i < inputs_.size(); ++i)
            out[i] = function(inputs_[i]);
    }

  private:
    std::vector<Input> inputs_;
};

/// The catalogue row of a peer's function. `Input` is made of one case of type `Case`.
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
        if (job.ask != ask)
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
        return std::make_unique<EachCase<Input, function, answers>>(std::move(inputs));
    };
    return e;
}

inline Verdict yes_or_no(bool yes) { return {yes ? Answer::yes : Answer::no, 0}; }

/// A distance without a bound, and without witnesses, which nobody judges.
inline Distance plain_distance(double d) {
    Distance result;
    result.distance = result.lo = result.hi = d;
    return result;
}

} // namespace boxwood::bench
