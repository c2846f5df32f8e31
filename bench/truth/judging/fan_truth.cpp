#include "bench/truth/judging/case_text.h"
#include "bench/truth/judging/case_truths.h"
#include "bench/truth/judging/hits_alone.h"
#include "bench/truth/judging/moved_corners.h"
#include "bench/truth/judging/tally.h"
#include "bench/truth/judging/truths.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/roots.h"
#include "kernels/oracle/second_opinion.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

namespace boxwood::bench {
namespace {

struct TrueHit {
    bool hit;
    double t; ///< the nearest double to the nearest hit; NaN if it is a miss
};

double float_ulp(double x) {
    int exponent = 0;
    std::frexp(x, &exponent);
    return std::ldexp(1.0, std::max(exponent - 24, -149));
}

/// What exact.h says of its numbers; a truth in double is 2^-29 ulp off.
constexpr double max_ulp = 0.63 + 0x1p-29, max_weight_error = 0x1p-23;

/// The nearest of a fan or mesh, up to the largest float. Whether it must be hit may be known
/// better: a closed fan has no gaps.
TrueHit truth_of(const RayCase& c, const std::vector<Triangle<float>>& triangles) {
    std::optional<mpq_class> nearest;
    for (std::uint32_t k = c.first; k < c.first + c.count; ++k) {
        const Triangle<float>& t = triangles[k];
        if (!is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c))
            continue; // a miss, as the kernels say
        const auto point = oracle::ray_triangle(c.ray, t);
        require_agreement(point == oracle::second_opinion::ray_triangle(c.ray, t),
                          [&] { return text_of(c) + " and " + text_of(t); });
        if (point && std::isfinite(oracle::nearest_float(point->t)) &&
            (!nearest || point->t < *nearest))
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
            if (contender.promise == Promise::never_leaks && cases_.rays[i].is_closed() &&
                truths[i]->hit && !said.hit())
                tally.leaked(i);
            else
                tally.answered(i, said.hit() ? Answer::yes : Answer::no, truths[i]->hit);
            if (contender.promise == Promise::never_leaks && !is_within_moves(i, said)) {
                tally.violated();
                tally.note(i, Worth::broken_promise);
            }
            if (contender.promise != Promise::none && !contender.layout.empty() &&
                !is_as_alone(i, said, contender.kernel)) {
                tally.violated();
                tally.note(i, Worth::broken_promise);
            }
            if (!said.hit() || std::isnan(truths[i]->t) || scene_.task == "rays_any")
                continue;
            if (contender.promise == Promise::exact && !is_exact(i, said, truths[i]->t)) {
                tally.violated();
                tally.note(i, Worth::broken_promise);
            }
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
        return hit.hit()
                   ? fmt::format("hit at t = {:a}, u = {:a}, v = {:a} of triangle {}",
                                 static_cast<double>(hit.t), static_cast<double>(hit.u),
                                 static_cast<double>(hit.v), hit.triangle - cases_.rays[i].first)
                   : "miss";
    }

  private:
    /// Whether a tree finds what the kernel does without one: bit for bit, of several at one t the
    /// lowest triangle; of any hit whether there is one.
    bool is_as_alone(std::size_t i, const RayHit& said, const std::string& kernel) {
        const RayHit& alone = closest_alone(kernel)[i];
        return scene_.task == "rays_any" ? said.hit() == alone.hit() : said == alone;
    }
    const std::vector<RayHit>& closest_alone(const std::string& kernel) {
        const auto [at, is_new] = alone_.try_emplace(kernel);
        if (is_new)
            for (const RayCase& c : cases_.rays) {
                const auto hits = hits_alone(kernel, c, cases_.triangles);
                at->second.push_back(hits.empty() ? RayHit{} : hits.front());
            }
        return at->second;
    }

    /// Whether the answer is right for some corners that are moved as never-leaks allows: a miss
    /// only if no triangle is surely hit, a hit no farther than those and of the triangle that is
    /// named; of any hit the triangle does not count.
    bool is_within_moves(std::size_t i, const RayHit& said) const {
        const RayCase& c = cases_.rays[i];
        const bool is_any = scene_.task == "rays_any";
        bool may_hit = false;
        for (std::uint32_t k = c.first; k < c.first + c.count; ++k) {
            const MovedCorners moved(c.ray, cases_.triangles[k]);
            may_hit |= moved.allow_a_hit();
            if (const auto t = moved.surely_hit_by();
                t && !(said.hit() && (is_any || static_cast<double>(said.t) <= *t)))
                return false;
        }
        if (!said.hit())
            return true;
        return is_any ? may_hit
                      : said.triangle >= c.first && said.triangle - c.first < c.count &&
                            MovedCorners(c.ray, cases_.triangles[said.triangle]).allow(said);
    }

    /// Whether t is the nearest one's, and t, u and v are those of the triangle that is named.
    bool is_exact(std::size_t i, const RayHit& said, double nearest) const {
        const RayCase& c = cases_.rays[i];
        if (said.triangle < c.first || said.triangle - c.first >= c.count)
            return false;
        const auto point = oracle::ray_triangle(c.ray, cases_.triangles[said.triangle]);
        if (!point)
            return false;
        const auto is_near = [](float x, double truth, double error) {
            return std::abs(static_cast<double>(x) - truth) <= error;
        };
        const double t = oracle::nearest_double(point->t);
        return is_near(said.t, nearest, max_ulp * float_ulp(nearest)) &&
               is_near(said.t, t, max_ulp * float_ulp(t)) &&
               is_near(said.u, oracle::nearest_double(point->u), max_weight_error) &&
               is_near(said.v, oracle::nearest_double(point->v), max_weight_error);
    }

    std::string first_triangle(std::size_t i) const {
        if (cases_.rays[i].count != 1)
            return "";
        return " (" + text_of(cases_.triangles[cases_.rays[i].first]) + ")";
    }

    CaseScene scene_;
    const RayCases& cases_;
    Truths<RayCase, TrueHit> truths_;
    std::map<std::string, std::vector<RayHit>> alone_; ///< by kernel
};

} // namespace

std::unique_ptr<CaseTruth> make_fan_truth(const CaseScene& scene) {
    return std::make_unique<FanTruth>(scene);
}

} // namespace boxwood::bench
