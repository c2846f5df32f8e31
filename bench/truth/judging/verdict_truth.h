#pragma once

#include "bench/truth/judging/case_text.h"
#include "bench/truth/judging/case_truths.h"
#include "bench/truth/judging/tally.h"
#include "bench/truth/judging/truths.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace boxwood::bench {

template <class Case> class VerdictTruth final : public CaseTruth {
  public:
    using Oracle = bool (*)(const Case&);
    using Command = std::string (*)(const ContenderEntry&);

    VerdictTruth(const CaseScene& scene, Oracle oracle, Command command)
        : scene_(scene), command_(command), cases_(std::get<std::vector<Case>>(scene.scene.cases)),
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
    CaseScene scene_;
    Command command_;
    const std::vector<Case>& cases_;
    Truths<Case, bool> truths_;
};

/// Yes or no of each case. command: what a case in words can be piped into, if something.
template <class Case>
std::unique_ptr<CaseTruth>
make_verdict_truth(const CaseScene& scene, typename VerdictTruth<Case>::Oracle oracle,
                   typename VerdictTruth<Case>::Command command = nullptr) {
    return std::make_unique<VerdictTruth<Case>>(scene, oracle, command);
}

} // namespace boxwood::bench
