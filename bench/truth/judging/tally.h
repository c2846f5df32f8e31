#pragma once

#include "bench/truth/judging/case_truths.h"

#include <cmath>
#include <cstdint>
#include <optional>

namespace boxwood::bench {

/// What one answer is worth, worst last.
enum class Worth { exact, conservative, within_bound, wrong, broken_promise };

/// A yes/no answer against the truth, by what its kernel promises.
Worth worth_of(Promise promise, Answer said, bool truth);

/// Counts over the cases of one contender, and the first of its worst cases.
class Tally {
  public:
    Tally(const CaseScene& scene, const ContenderEntry& contender);

    Promise promise() const { return promise_; }

    /// One call more, by the tier that decided it.
    void called(std::uint8_t tier);
    /// A yes/no answer.
    void answered(std::size_t i, Answer said, bool truth);
    void too_small() { ++row_.false_pos; }
    void too_large() { ++row_.false_neg; }
    void undecided() { ++row_.maybe; }
    void violated() { ++row_.bound_violations; }
    /// A miss where what never leaks has to hit: a violation, and no false no besides.
    void leaked(std::size_t i);
    /// An answer that is not false but says little: undecided, false on the permitted side, or far
    /// wider than rounding.
    void vague(std::size_t i);
    void error(double ulp, double relative);
    /// Notes what case `i` is worth; NaN and zero errors do not matter here.
    void note(std::size_t i, Worth worth);

    /// The rows. `witness` says a case and its answer in words.
    template <class Witness> Judgement finish(const Witness& witness) {
        if (is_useless()) {
            violated();
            note(first_vague_, Worth::broken_promise);
        }
        return rows(worst_ >= Worth::wrong ? witness(worst_case_) : std::string());
    }

  private:
    Judgement rows(std::string witness) const;
    /// Whether too much of generic input is left undecided: more than Promise allows.
    bool is_useless() const;

    Promise promise_;
    bool yes_is_proven_;
    Panel panel_;
    std::size_t n_cases_;
    bool is_by_construction_; ///< the truth
    results::KernelRow row_;
    bool is_yes_no_ = false;
    std::uint64_t true_yes_ = 0, said_yes_ = 0;
    Worth worst_ = Worth::exact;
    std::size_t worst_case_ = 0, first_vague_ = 0, n_vague_ = 0;
};

} // namespace boxwood::bench
