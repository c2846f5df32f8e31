#include "bench/truth/rays_all_truth.h"

#include "bench/truth/ray_truth.h"
#include "bench/truth/sample.h"
#include "trees/executor.h"
#include "trees/queries/sinks.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace boxwood::bench {
namespace {

class AllHitsTruth final : public Truth {
  public:
    AllHitsTruth(const Scene& scene, unsigned threads)
        : n_rays_(scene.rays.size()), n_triangles_(scene.mesh.triangles.size()),
          sample_(sampled_rays(scene)), truths_(sample_.size()) {
        const RayOracle oracle(scene.mesh);
        make_executor("tbb", threads)->for_each(sample_.size(), [&](std::size_t k) {
            truths_[k] = oracle.all(scene.rays[sample_[k]]);
        });
    }

    Judgement judge(const Answers& answers, const ContenderEntry&) override {
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = "brute_force_f64";
        check.n_checked = sample_.size();
        std::vector<Pair> got = list_of<Pair>(answers);
        std::ranges::sort(got);
        const auto note = [&](const char* what, Pair p) {
            if (check.witness.empty())
                check.witness = fmt::format("{} (ray {}, triangle {})", what, p.a, p.b);
        };
        for (const Pair& p : got)
            if (p.a >= n_rays_ || p.b >= n_triangles_) {
                ++check.extra;
                note("no such answer", p);
            }
        bool all_certain = true;
        for (std::size_t k = 0; k < sample_.size(); ++k) {
            const auto ray = static_cast<std::uint32_t>(sample_[k]);
            const std::span<const Pair> own(std::ranges::lower_bound(got, ray, {}, &Pair::a),
                                            std::ranges::upper_bound(got, ray, {}, &Pair::a));
            check.n_got += own.size();
            for (const RayTruth::Candidate& c : truths_[k]) {
                all_certain = all_certain && c.certain;
                check.n_expected += c.certain;
                if (c.certain && !std::ranges::binary_search(own, Pair{ray, c.triangle})) {
                    ++check.missing;
                    note("missing", {ray, c.triangle});
                }
            }
            for (auto p = own.begin(); p != own.end(); ++p) {
                const bool twice = p != own.begin() && p[-1] == *p;
                if (p->b < n_triangles_ &&
                    (twice || !std::ranges::binary_search(truths_[k], p->b, {},
                                                          &RayTruth::Candidate::triangle))) {
                    ++check.extra;
                    note(twice ? "twice" : "extra", *p);
                }
            }
        }
        judgement.conclude(all_certain);
        return judgement;
    }

  private:
    std::size_t n_rays_, n_triangles_;
    std::vector<std::size_t> sample_;
    std::vector<std::vector<RayTruth::Candidate>> truths_; ///< by triangle
};

} // namespace

std::vector<std::size_t> sampled_rays(const Scene& scene) {
    const std::size_t n_rays = scene.rays.size();
    const std::size_t triangles = std::max<std::size_t>(1, scene.mesh.triangles.size());
    const std::size_t m =
        std::min(n_rays, std::clamp<std::size_t>(20'000'000 / triangles, 64, 1024));
    return sampled_queries(n_rays, m, scene.spec.seed);
}

std::unique_ptr<Truth> make_all_hits_truth(const Scene& scene, unsigned threads) {
    return std::make_unique<AllHitsTruth>(scene, threads);
}

} // namespace boxwood::bench
