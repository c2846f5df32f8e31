#include "bench/truth/judging/case_text.h"
#include "bench/truth/judging/case_truths.h"
#include "bench/truth/judging/tally.h"
#include "bench/truth/judging/truths.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/roots.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace boxwood::bench {
namespace {

/// A finite number, or an infinity, against a fraction: below 0 if x < q.
int compared(double x, const mpq_class& q) {
    return std::isfinite(x) ? cmp(mpq_class(x), q) : x < 0 ? -1 : 1;
}

struct TrueBox {
    oracle::RationalBox box;
    Aabb<double> nearest; ///< each number the nearest double
    double size;          ///< the largest of its coordinates' magnitudes
};

TrueBox truth_of(const FitCase& c) {
    TrueBox truth{oracle::image(c.transform, c.box), {}, 0};
    for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        truth.nearest.min[k] = oracle::nearest_double(truth.box.min[axis]);
        truth.nearest.max[k] = oracle::nearest_double(truth.box.max[axis]);
        truth.size =
            std::max({truth.size, std::abs(truth.nearest.min[k]), std::abs(truth.nearest.max[k])});
    }
    return truth;
}

bool holds(const Aabb<double>& said, const TrueBox& truth) {
    for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        if (std::isnan(said.min[k]) || std::isnan(said.max[k]) ||
            compared(said.min[k], truth.box.min[axis]) > 0 ||
            compared(said.max[k], truth.box.max[axis]) < 0)
            return false;
    }
    return true;
}

/// How far it reaches beyond (or falls short of) the exact box on any side.
double excess(const Aabb<double>& said, const TrueBox& truth) {
    double max_magnitude = 0;
    for (int k = 0; k < 3; ++k)
        max_magnitude = std::max({max_magnitude, std::abs(said.min[k] - truth.nearest.min[k]),
                                  std::abs(said.max[k] - truth.nearest.max[k])});
    return max_magnitude;
}

class FitTruth final : public CaseTruth {
  public:
    explicit FitTruth(const CaseScene& scene)
        : scene_(scene), cases_(std::get<std::vector<FitCase>>(scene.scene.cases)),
          truths_(cases_, scene.threads, [](const FitCase& c) { return truth_of(c); }) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        require_one_per_case(answers, cases_.size());
        const auto& truths = truths_.of(contender.precision);
        Tally tally(scene_, contender);
        for (std::size_t i = 0; i < cases_.size(); ++i) {
            if (!truths[i])
                continue;
            const Aabb<double>& said = list_of<Aabb<double>>(answers)[i];
            tally.called(0);
            const double error = excess(said, *truths[i]) / truths[i]->size;
            tally.error(results::missing, error);
            if (!(error <= 0x1p-16))
                tally.vague(i);
            if (holds(said, *truths[i])) {
                tally.note(i, said == truths[i]->nearest ? Worth::exact : Worth::conservative);
                continue;
            }
            tally.violated();
            tally.note(i,
                       contender.promise == Promise::none ? Worth::wrong : Worth::broken_promise);
        }
        return tally.finish([&](std::size_t i) {
            return fmt::format("case {}: said {}, truth {}; {}; {}", i, answer_text(answers, i),
                               truth_text(i, contender.precision),
                               text_of(truths_.as_read(i, contender.precision)),
                               replay_command(scene_, contender.name, i));
        });
    }

    std::string case_text(std::size_t i) const override { return text_of(cases_[i]); }
    std::string truth_text(std::size_t i, const std::string& precision) override {
        const auto& truth = truths_.of(precision)[i];
        return truth ? text_of(truth->nearest) + " (nearest)" : "none: not finite";
    }
    std::string answer_text(const Answers& answers, std::size_t i) const override {
        return text_of(list_of<Aabb<double>>(answers)[i]);
    }

  private:
    static std::string text_of(const Aabb<double>& box) {
        return fmt::format("[{:a} {:a} {:a}, {:a} {:a} {:a}]", box.min.x, box.min.y, box.min.z,
                           box.max.x, box.max.y, box.max.z);
    }
    static std::string text_of(const FitCase& c) { return bench::text_of(c); }

    CaseScene scene_;
    const std::vector<FitCase>& cases_;
    Truths<FitCase, TrueBox> truths_;
};

} // namespace

std::unique_ptr<CaseTruth> make_fit_truth(const CaseScene& scene) {
    return std::make_unique<FitTruth>(scene);
}

} // namespace boxwood::bench
