#include "bench/truth/judging/case_text.h"
#include "bench/truth/judging/case_truths.h"
#include "bench/truth/judging/tally.h"
#include "bench/truth/judging/truths.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/roots.h"
#include "kernels/oracle/second_opinion.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace boxwood::bench {
namespace {

struct TrueHit {
    bool hit;
    double t; ///< the nearest double to the nearest hit; NaN if it is a miss
};

/// The nearest of a fan. Whether it must be hit may be known better: a closed fan has no gaps.
TrueHit truth_of(const RayCase& c, const std::vector<Triangle<float>>& triangles) {
    std::optional<mpq_class> nearest;
    for (std::uint32_t k = c.first; k < c.first + c.count; ++k) {
        const Triangle<float>& t = triangles[k];
        if (!is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c))
            continue; // a miss, as the kernels say
        const auto point = oracle::ray_triangle(c.ray, t);
        require_agreement(point == oracle::second_opinion::ray_triangle(c.ray, t),
                          [&] { return text_of(c) + " and " + text_of(t); });
        if (point && (!nearest || point->t < *nearest))
            nearest = point->t;
    }
    return {c.hit == Known::unknown ? nearest.has_value() : c.hit == Known::yes,
            nearest ? oracle::nearest_double(*nearest) : std::nan("")};
}

class FanTruth final : public CaseTruth {
  public:
    explicit FanTruth(const CaseScene& scene)
        : scene_(scene), cases_(std::get<RayCases>(scene.scene.cases)),
          truths_(cases_.rays, scene.threads,
                  [this](const RayCase& c) { return truth_of(c, cases_.triangles); }) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        require_one_per_case(answers, cases_.rays.size());
        const auto& truths = truths_.of(contender.precision);
        Tally tally(scene_, contender);
        for (std::size_t i = 0; i < truths.size(); ++i) {
            if (!truths[i])
                continue;
            const RayHit& said = list_of<RayHit>(answers)[i];
            tally.called(0);
            tally.answered(i, said.hit() ? Answer::yes : Answer::no, truths[i]->hit);
            if (!said.hit() || std::isnan(truths[i]->t))
                continue;
            const auto t = static_cast<double>(said.t);
            if (t != truths[i]->t) {
                const double error = std::abs(t - truths[i]->t);
                tally.error(error / float_ulp(truths[i]->t),
                            truths[i]->t > 0 ? error / truths[i]->t : results::missing);
            } else {
                tally.error(0, 0);
            }
        }
        return tally.finish([&](std::size_t i) {
            return fmt::format("case {}: said {}, truth {}; {}, {} triangles{}; {}", i,
                               answer_text(answers, i), truth_text(i, contender.precision),
                               case_text(i), cases_.rays[i].count, first_triangle(i),
                               replay_command(scene_, contender.name, i));
        });
    }

    std::string case_text(std::size_t i) const override { return text_of(cases_.rays[i]); }
    std::string truth_text(std::size_t i, const std::string& precision) override {
        const auto& truth = truths_.of(precision)[i];
        return !truth                 ? "none: not finite"
               : !truth->hit          ? "miss"
               : std::isnan(truth->t) ? "hit" // known by construction
                                      : fmt::format("hit at t = {:a}", truth->t);
    }
    std::string answer_text(const Answers& answers, std::size_t i) const override {
        const RayHit& hit = list_of<RayHit>(answers)[i];
        return hit.hit() ? fmt::format("hit at t = {:a}", static_cast<double>(hit.t)) : "miss";
    }

  private:
    std::string first_triangle(std::size_t i) const {
        if (cases_.rays[i].count != 1)
            return "";
        return " (" + text_of(cases_.triangles[cases_.rays[i].first]) + ")";
    }

    static double float_ulp(double x) {
        int exponent = 0;
        std::frexp(x, &exponent);
        return std::ldexp(1.0, std::max(exponent - 24, -149));
    }

    CaseScene scene_;
    const RayCases& cases_;
    Truths<RayCase, TrueHit> truths_;
};

} // namespace

std::unique_ptr<CaseTruth> make_fan_truth(const CaseScene& scene) {
    return std::make_unique<FanTruth>(scene);
}

} // namespace boxwood::bench
