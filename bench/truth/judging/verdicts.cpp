#include "bench/truth/judging/case_text.h"
#include "bench/truth/judging/judges.h"
#include "bench/truth/judging/tally.h"
#include "bench/truth/judging/truths.h"
#include "kernels/oracle/oracle.h"

#include <fmt/format.h>

namespace boxwood::bench {
namespace {

bool truth_of(const TrianglePairCase& c) {
    return c.touch == Known::unknown ? oracle::intersect(c.a, c.b) : c.touch == Known::yes;
}

bool truth_of(const RayBoxCase& c) {
    return c.hit == Known::unknown ? oracle::ray_box(c.ray, c.box) : c.hit == Known::yes;
}

bool truth_of(const ObbPairCase& c) {
    if (c.touch != Known::unknown)
        return c.touch == Known::yes;
    const auto pose = [](const Obb<double>& box) {
        return std::array{box.centre, box.axis[0], box.axis[1], box.axis[2]};
    };
    return oracle::boxes_touch(pose(c.a), c.a.half, pose(c.b), c.b.half);
}

template <class Case> class VerdictJudge final : public Judge {
  public:
    VerdictJudge(const Scene& scene, Ask ask, unsigned threads)
        : scene_(scene), ask_(ask), cases_(std::get<std::vector<Case>>(scene.cases)),
          truths_(cases_, threads, [](const Case& c) { return truth_of(c); }) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        require_one_per_case(answers.verdicts.size(), cases_.size());
        const auto& truths = truths_.of(contender.precision);
        Tally tally(contender);
        for (std::size_t i = 0; i < cases_.size(); ++i) {
            if (!truths[i])
                continue;
            tally.called(answers.verdicts[i].tier);
            tally.answered(i, answers.verdicts[i].answer, *truths[i]);
        }
        return tally.finish([&](std::size_t i) {
            return fmt::format("case {}: said {}, truth {}; {}{}; {}", i, answer_text(answers, i),
                               text_of(*truths[i]),
                               text_of(truths_.as_read(i, contender.precision)),
                               ask_ == Ask::triangle_triangle ? query_command(contender, ask_) : "",
                               replay_command(scene_, ask_, contender.name, i));
        });
    }

    std::string case_text(std::size_t i) const override { return text_of(cases_[i]); }
    std::string truth_text(std::size_t i, const std::string& precision) override {
        const auto& truth = truths_.of(precision)[i];
        return truth ? text_of(*truth) : "none: not finite";
    }
    std::string answer_text(const Answers& answers, std::size_t i) const override {
        const Decision& verdict = answers.verdicts[i];
        return verdict.tier == 0
                   ? text_of(verdict.answer)
                   : fmt::format("{} (tier {})", text_of(verdict.answer), verdict.tier);
    }

  private:
    const Scene& scene_;
    Ask ask_;
    const std::vector<Case>& cases_;
    Truths<Case, bool> truths_;
};

} // namespace

std::unique_ptr<Judge> verdict_judge(const Scene& scene, Ask ask, unsigned threads) {
    if (ask == Ask::ray_box)
        return std::make_unique<VerdictJudge<RayBoxCase>>(scene, ask, threads);
    if (ask == Ask::obb_obb)
        return std::make_unique<VerdictJudge<ObbPairCase>>(scene, ask, threads);
    return std::make_unique<VerdictJudge<TrianglePairCase>>(scene, ask, threads);
}

} // namespace boxwood::bench
