#pragma once

#include "bench/truth/judging/case_text.h"
#include "bench/truth/judging/case_truths.h"
#include "bench/truth/judging/tally.h"
#include "bench/truth/judging/truths.h"

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace boxwood::bench {

template <class Case> class VerdictTruth final : public CaseTruth {
  public:
    using Oracle = bool (*)(const Case&);
    using Command = std::string (*)(const ContenderEntry&);
    /// How far a case is from where the answer turns, as a part of its size.
    using Nearness = double (*)(const Case&);

    VerdictTruth(const CaseScene& scene, Oracle oracle, Command command, Nearness nearness)
        : scene_(scene), command_(command), nearness_(nearness),
          cases_(std::get<std::vector<Case>>(scene.scene.cases)),
          truths_(cases_, scene.threads, oracle) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        require_one_per_case(answers, cases_.size());
        const std::vector<Decision>& verdicts = list_of<Decision>(answers);
        const auto& truths = truths_.of(contender.precision);
        Tally tally(scene_, contender);
        for (std::size_t i = 0; i < cases_.size(); ++i) {
            if (!truths[i])
                continue;
            tally.called(verdicts[i].tier);
            if (is_near_miss(i, verdicts[i].answer, *truths[i], contender, tally))
                continue;
            tally.answered(i, verdicts[i].answer, *truths[i]);
        }
        return tally.finish([&](std::size_t i) {
            return fmt::format("case {}: said {}, truth {}; {}{}; {}", i, text_of(verdicts[i]),
                               text_of(*truths[i]),
                               text_of(truths_.as_read(i, contender.precision)),
                               command_ ? command_(contender) : std::string(),
                               replay_command(scene_, contender.name, i));
        });
    }

    std::string case_text(std::size_t i) const override { return text_of(cases_[i]); }
    std::string truth_text(std::size_t i, const std::string& precision) override {
        const auto& truth = truths_.of(precision)[i];
        return truth ? text_of(*truth) : "none: not finite";
    }
    std::string answer_text(const Answers& answers, std::size_t i) const override {
        return text_of(list_of<Decision>(answers)[i]);
    }

  private:
    /// What promises nothing may answer wrongly where it may be so far off; noted then.
    bool is_near_miss(std::size_t i, Answer said, bool truth, const ContenderEntry& contender,
                      Tally& tally) const {
        if (!nearness_ || contender.promise != Promise::none || said == Answer::maybe ||
            (said == Answer::yes) == truth)
            return false;
        const double off = nearness_(truths_.as_read(i, contender.precision));
        if (!(off <= peers_error(contender.precision)))
            return false;
        tally.error(std::numeric_limits<double>::quiet_NaN(), off);
        tally.note(i, Worth::within_bound);
        return true;
    }

    CaseScene scene_;
    Command command_;
    Nearness nearness_;
    const std::vector<Case>& cases_;
    Truths<Case, bool> truths_;
};

/// Yes or no of each case. command: what a case in words can be piped into, if something.
/// nearness: libraries are allowed peers_error by it, if given.
template <class Case>
std::unique_ptr<CaseTruth>
make_verdict_truth(const CaseScene& scene, typename VerdictTruth<Case>::Oracle oracle,
                   typename VerdictTruth<Case>::Command command = nullptr,
                   typename VerdictTruth<Case>::Nearness nearness = nullptr) {
    return std::make_unique<VerdictTruth<Case>>(scene, oracle, command, nearness);
}

} // namespace boxwood::bench
