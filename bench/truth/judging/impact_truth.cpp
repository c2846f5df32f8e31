#include "bench/truth/judging/case_text.h"
#include "bench/truth/judging/case_truths.h"
#include "bench/truth/judging/tally.h"
#include "bench/truth/judging/truths.h"
#include "kernels/oracle/rational.h"
#include "kernels/oracle/roots.h"
#include "kernels/oracle/second_opinion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood::bench {
namespace {

struct TrueImpact {
    bool touch;
    Impact first; ///< between neighbouring doubles, if they touch
};

TrueImpact truth_of(const MotionCase& c, MotionKind kind) {
    const oracle::ExactContinuous exact;
    const Impact first =
        kind == MotionKind::vertex_face ? exact.vertex_face(c.motion) : exact.edge_edge(c.motion);
    const bool touch = first.answer == Answer::yes;
    const bool is_right = c.touch == Known::unknown || (c.touch == Known::yes) == touch;
    const auto confirms = kind == MotionKind::vertex_face
                              ? oracle::second_opinion::confirms_vertex_face
                              : oracle::second_opinion::confirms_edge_edge;
    require_agreement(is_right && confirms(c.motion, first), [&] { return text_of(c); });
    return {touch, first};
}

class ImpactTruth final : public CaseTruth {
  public:
    explicit ImpactTruth(const CaseScene& scene)
        : scene_(scene), cases_(std::get<MotionCases>(scene.scene.cases)),
          truths_(cases_.motions, scene.threads,
                  [this](const MotionCase& c) { return truth_of(c, cases_.kind); }) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        require_one_per_case(answers, cases_.motions.size());
        const auto& truths = truths_.of(contender.precision);
        Tally tally(scene_, contender);
        for (std::size_t i = 0; i < truths.size(); ++i) {
            if (!truths[i])
                continue;
            const Impact& said = list_of<Impact>(answers)[i];
            tally.called(said.tier);
            tally.answered(i, said.answer, truths[i]->touch);
            if (truths[i]->touch)
                judge_time(tally, i, said, truths[i]->first);
            else if (tally.promise() != Promise::none && !is_miss(said))
                broken(tally, i);
        }
        return tally.finish([&](std::size_t i) {
            return fmt::format("case {}: said {}, truth {}; {}; {}", i, answer_text(answers, i),
                               truth_text(i, contender.precision), case_text(i),
                               replay_command(scene_, contender.name, i));
        });
    }

    std::string case_text(std::size_t i) const override { return text_of(cases_.motions[i]); }
    std::string truth_text(std::size_t i, const std::string& precision) override {
        const auto& truth = truths_.of(precision)[i];
        return !truth ? "none: not finite"
               : truth->touch
                   ? fmt::format("yes, t in [{:a}, {:a}]", truth->first.t_free, truth->first.t_hit)
                   : "no";
    }
    std::string answer_text(const Answers& answers, std::size_t i) const override {
        const Impact& said = list_of<Impact>(answers)[i];
        return fmt::format("{}, t in [{:a}, {:a}] (tier {})", text_of(said.answer), said.t_free,
                           said.t_hit, said.tier);
    }

  private:
    /// The error is that of t, relative to the step. A kernel with a promise must not call free
    /// what is not, nor end before the first touch, which is `first` if that is a double, else
    /// inside it; between an exact one's times there is no double.
    static void judge_time(Tally& tally, std::size_t i, const Impact& said, const Impact& first) {
        const double error =
            std::max(std::abs(said.t_free - first.t_free), std::abs(said.t_hit - first.t_hit));
        if (said.answer == Answer::yes && std::isfinite(said.t_hit))
            tally.error(results::missing, error);
        if (said.answer == Answer::yes && !(error <= 0x1p-16))
            tally.vague(i);
        if (tally.promise() == Promise::none)
            return;
        const bool too_wide =
            tally.promise() == Promise::exact && !(said.t_hit <= oracle::next_above(said.t_free));
        if (!(said.t_free >= 0 && said.t_free <= first.t_free) ||
            (said.answer == Answer::yes && !(said.t_hit >= first.t_hit)) || too_wide)
            broken(tally, i);
    }
    static void broken(Tally& tally, std::size_t i) {
        tally.violated();
        tally.note(i, Worth::broken_promise);
    }
    /// Of two that never touch a no says so for all times, and what is not sure begins at none
    /// before 0.
    static bool is_miss(const Impact& said) {
        return said.answer == Answer::no
                   ? said.t_free == 1 && said.t_hit == std::numeric_limits<double>::infinity()
                   : said.t_free >= 0;
    }

    CaseScene scene_;
    const MotionCases& cases_;
    Truths<MotionCase, TrueImpact> truths_;
};

} // namespace

std::unique_ptr<CaseTruth> make_impact_truth(const CaseScene& scene) {
    return std::make_unique<ImpactTruth>(scene);
}

} // namespace boxwood::bench
