#include "bench/truth/hit_truth.h"

#include "bench/truth/ray_truth.h"
#include "bench/truth/rays_all_truth.h"
#include "trees/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boxwood::bench {
namespace {

class HitTruth final : public Truth {
  public:
    HitTruth(const Scene& scene, RayQuery query, unsigned threads)
        : query_(query), n_rays_(scene.rays.size()) {
        if (scene.rays.empty())
            return;
        sample_ = sampled_rays(scene);
        const RayOracle oracle(scene.mesh);
        truths_.resize(sample_.size());
        make_executor("tbb", threads)->for_each(sample_.size(), [&](std::size_t k) {
            truths_[k] = oracle.truth(scene.rays[sample_[k]]);
        });
    }

    Judgement judge(const Answers& answers, const ContenderEntry&) override {
        const std::vector<RayHit>& hits = list_of<RayHit>(answers);
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = "brute_force_f64";
        if (hits.size() != n_rays_) {
            judgement.status = Status::wrong;
            check.n_got = hits.size();
            check.n_expected = n_rays_;
            check.missing = n_rays_ > check.n_got ? n_rays_ - check.n_got : 0;
            check.extra = check.n_got > n_rays_ ? check.n_got - n_rays_ : 0;
            check.witness = fmt::format("{} answers for {} rays", check.n_got, n_rays_);
            return judgement;
        }
        bool all_certain = true;
        check.n_checked = sample_.size();
        if (query_ == RayQuery::closest)
            check.max_abs_err = check.max_rel_err = 0;
        for (std::size_t k = 0; k < sample_.size(); ++k) {
            const RayTruth& truth = truths_[k];
            const RayHit& hit = hits[sample_[k]];
            check.n_expected += truth.must_hit();
            check.n_got += hit.hit();
            const std::string wrong = query_ == RayQuery::any
                                          ? judge_any(truth, hit, check, all_certain)
                                          : judge_closest(truth, hit, check, all_certain);
            if (!wrong.empty() && check.witness.empty())
                check.witness = fmt::format("ray {} {}", sample_[k], wrong);
        }
        judgement.conclude(all_certain);
        return judgement;
    }

  private:
    static std::string judge_any(const RayTruth& truth, const RayHit& hit, results::Check& check,
                                 bool& all_certain) {
        if (hit.hit() ? truth.candidates.empty() && !truth.must_hit() : truth.must_hit()) {
            ++(hit.hit() ? check.extra : check.missing);
            return hit.hit() ? "was said to hit, but meets nothing"
                             : fmt::format("was said to miss, but {}", nearest(truth));
        }
        all_certain &= truth.must_hit() || truth.candidates.empty();
        return {};
    }

    /// "missed triangle 5 at t=0x1.8p+0"
    static std::string nearest(const RayTruth& truth) {
        const auto first = std::ranges::min_element(truth.candidates, {}, [](const auto& c) {
            return c.certain ? c.t : std::numeric_limits<double>::infinity();
        });
        if (first == truth.candidates.end() || !first->certain)
            return fmt::format("meets an edge or corner of a closed surface before t={:a}",
                               truth.t_limit);
        return fmt::format("meets triangle {} at t={:a}", first->triangle, first->t);
    }

    static std::string judge_closest(const RayTruth& truth, const RayHit& hit,
                                     results::Check& check, bool& all_certain) {
        if (!hit.hit()) {
            all_certain &= truth.candidates.empty();
            if (!truth.must_hit())
                return {};
            ++check.missing;
            return fmt::format("was said to miss, but {}", nearest(truth));
        }
        const double t = static_cast<double>(hit.t);
        const auto c =
            std::ranges::find(truth.candidates, hit.triangle, &RayTruth::Candidate::triangle);
        if (truth.must_hit() && !(t <= truth.t_limit)) {
            ++check.missing;
            return fmt::format("was said to hit triangle {} at t={:a}, but {}", hit.triangle, t,
                               nearest(truth));
        }
        if (c == truth.candidates.end() || !(c->t_low <= t && t <= c->t_high)) {
            ++check.extra;
            check.bound_violations += c != truth.candidates.end();
            return fmt::format(
                "was said to hit triangle {} at t={:a}, where it is not{}", hit.triangle, t,
                c == truth.candidates.end()
                    ? std::string()
                    : fmt::format(" (t between {:a} and {:a})", c->t_low, c->t_high));
        }
        all_certain &= c->certain;
        if (c->certain) {
            const double error = std::abs(t - c->t);
            check.max_abs_err = std::max(check.max_abs_err, error);
            if (error > 0)
                check.max_rel_err = std::max(check.max_rel_err, error / std::abs(c->t));
        }
        return {};
    }

    RayQuery query_;
    std::size_t n_rays_;
    std::vector<std::size_t> sample_;
    std::vector<RayTruth> truths_;
};

} // namespace

std::unique_ptr<Truth> make_hit_truth(const Scene& scene, RayQuery query, unsigned threads) {
    return std::make_unique<HitTruth>(scene, query, threads);
}

} // namespace boxwood::bench
