#include "bench/truth/truth.h"

#include "bench/truth/column_sweep.h"
#include "bench/peers/brute_force.h"
#include "bench/truth/point_truth.h"
#include "bench/truth/ray_truth.h"
#include "bench/truth/rays_all_truth.h"
#include "kernels/oracle/oracle.h"
#include "trees/executor.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace boxwood::bench {
namespace {

/// Up to here every pair is tested, in some tenth of a second. Beyond, those of one column.
constexpr std::size_t most_boxes_for_all_pairs = 20'000;

/// Calls body(i, part) for each i < n on `threads` threads and joins the parts, sorted.
template <class Body> std::vector<Pair> gather(std::size_t n, unsigned threads, const Body& body) {
    std::vector<std::vector<Pair>> parts(n);
    make_executor("tbb", threads)->for_each(n, [&](std::size_t i) { body(i, parts[i]); });
    return sorted_pairs(std::move(parts));
}

constexpr std::size_t rows_per_part = 4 * BruteForce::tile;

std::size_t parts_of(std::size_t n) { return (n + rows_per_part - 1) / rows_per_part; }

/// Columns [begin, n) against the rows before min(column, row_end).
std::vector<Pair> all_pairs(std::span<const Aabb<float>> boxes, std::size_t begin,
                            std::size_t row_end, unsigned threads) {
    const BruteForce columns(boxes);
    const std::size_t n = boxes.size();
    return gather(parts_of(n - begin), threads, [&](std::size_t part, std::vector<Pair>& out) {
        const std::size_t first = begin + part * rows_per_part;
        columns.append_columns(first, std::min(n, first + rows_per_part), row_end, out);
    });
}

/// Of the pairs whose boxes overlap, those whose triangles share a point: a corner of the mesh by
/// number, else by the rational oracle.
std::vector<Pair> touching(const TriangleMesh& mesh, std::vector<Pair> candidates,
                           unsigned threads) {
    const auto triangle = [&](std::uint32_t i) {
        const Triangle<float> t = mesh.triangle(i);
        return Triangle<double>{Vec3<double>(t.a), Vec3<double>(t.b), Vec3<double>(t.c)};
    };
    const auto share_a_corner = [&](Pair p) {
        return std::ranges::any_of(mesh.triangles[p.a], [&](std::uint32_t corner) {
            return std::ranges::find(mesh.triangles[p.b], corner) != mesh.triangles[p.b].end();
        });
    };
    std::vector<std::uint8_t> touch(candidates.size());
    make_executor("tbb", threads)->for_each(candidates.size(), [&](std::size_t i) {
        const Pair p = candidates[i];
        touch[i] = share_a_corner(p) || oracle::intersect(triangle(p.a), triangle(p.b));
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i)
        if (touch[i])
            candidates[kept++] = candidates[i];
    candidates.resize(kept);
    return candidates;
}

/// Holds number and hash of the pairs; which they are is found again where an answer differs.
class PairTruth final : public Truth {
  public:
    PairTruth(const Scene& scene, Ask ask, unsigned threads)
        : scene_(scene), ask_(ask), threads_(threads),
          is_small_(scene.boxes.size() <= most_boxes_for_all_pairs) {
        oracle_ = ask == Ask::triangle_pairs ? "rational" : is_small_ ? "brute_force" : "sweep";
        if (ask == Ask::triangle_pairs) {
            touching_ = touching(scene.mesh, overlapping(), threads);
            expected_ = digest_of(touching_);
        } else {
            expected_ = is_small_ ? digest_of(overlapping())
                                  : ColumnSweep(scene.boxes, threads).digest(left_out());
        }
    }

    results::Check check(const Answers& answers) const override {
        results::Check check;
        check.oracle = oracle_;
        check.n_checked = check.n_got = answers.pairs.size();
        check.n_expected = expected_.count;
        check.status = "exact";
        check.result_hash = answer_hash(answers, ask_);
        if (digest_of(answers.pairs) == expected_)
            return check;
        const PairsDifference wrong =
            difference(ask_ == Ask::triangle_pairs ? touching_ : overlapping(), answers.pairs);
        check.status = "wrong";
        check.missing = wrong.missing;
        check.extra = wrong.extra;
        check.witness = wrong.witness;
        return check;
    }

  private:
    /// Pairs of boxes of one side.
    std::function<bool(Pair)> left_out() const {
        if (ask_ != Ask::tree_pairs)
            return {};
        return [split = tree_pairs_split(scene_.boxes.size())](Pair p) {
            return p.a >= split || p.b < split;
        };
    }
    std::vector<Pair> overlapping() const {
        const std::size_t n = scene_.boxes.size(), split = tree_pairs_split(n);
        if (is_small_)
            return ask_ == Ask::tree_pairs ? all_pairs(scene_.boxes, split, split, threads_)
                                           : all_pairs(scene_.boxes, 0, n, threads_);
        std::vector<Pair> pairs = ColumnSweep(scene_.boxes, threads_).pairs();
        if (ask_ == Ask::tree_pairs)
            std::erase_if(pairs, left_out());
        return pairs;
    }

    const Scene& scene_;
    Ask ask_;
    unsigned threads_;
    bool is_small_;
    std::string oracle_;
    std::vector<Pair> touching_; ///< of triangle_pairs, ascending
    PairsDigest expected_;
};

class RaysTruth final : public Truth {
  public:
    RaysTruth(const Scene& scene, Ask ask, unsigned threads)
        : ask_(ask), n_rays_(scene.rays.size()) {
        if (scene.rays.empty())
            return;
        sample_ = sampled_rays(scene);
        const RayOracle oracle(scene.mesh);
        truths_.resize(sample_.size());
        make_executor("tbb", threads)->for_each(sample_.size(), [&](std::size_t k) {
            truths_[k] = oracle.truth(scene.rays[sample_[k]]);
        });
    }

    results::Check check(const Answers& answers) const override {
        results::Check check;
        check.oracle = "brute_force_f64";
        check.result_hash = answer_hash(answers, ask_);
        if (answers.hits.size() != n_rays_) {
            check.status = "wrong";
            check.n_got = answers.hits.size();
            check.n_expected = n_rays_;
            check.missing = n_rays_ > check.n_got ? n_rays_ - check.n_got : 0;
            check.extra = check.n_got > n_rays_ ? check.n_got - n_rays_ : 0;
            check.witness = fmt::format("{} answers for {} rays", check.n_got, n_rays_);
            return check;
        }
        bool all_certain = true;
        check.n_checked = sample_.size();
        if (ask_ == Ask::rays_closest)
            check.max_abs_err = check.max_rel_err = 0;
        for (std::size_t k = 0; k < sample_.size(); ++k) {
            const RayTruth& truth = truths_[k];
            const RayHit& hit = answers.hits[sample_[k]];
            check.n_expected += truth.must_hit();
            check.n_got += hit.hit();
            const std::string wrong = ask_ == Ask::rays_any
                                          ? judge_any(truth, hit, check, all_certain)
                                          : judge_closest(truth, hit, check, all_certain);
            if (!wrong.empty() && check.witness.empty())
                check.witness = fmt::format("ray {} {}", sample_[k], wrong);
        }
        check.status = check.missing || check.extra ? "wrong"
                       : all_certain                ? "exact"
                                                    : "within_bound";
        return check;
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

    Ask ask_;
    std::size_t n_rays_;
    std::vector<std::size_t> sample_;
    std::vector<RayTruth> truths_;
};

} // namespace

std::unique_ptr<Truth> make_truth(const Scene& scene, Ask ask, unsigned threads) {
    if (is_point_ask(ask))
        return make_point_truth(scene, ask, threads);
    if (ask == Ask::rays_all)
        return make_all_hits_truth(scene, threads);
    if (!is_ray_ask(ask))
        return std::make_unique<PairTruth>(scene, ask, threads);
    return std::make_unique<RaysTruth>(scene, ask, threads);
}

namespace {

/// Of the answers to kernel asks; of numbers the bits, padding left out.
std::uint64_t kernel_answer_hash(const Answers& answers) {
    std::vector<std::uint64_t> words;
    const auto add = [&](double x) { words.push_back(std::bit_cast<std::uint64_t>(x)); };
    const auto add_sure = [&](Answer answer, std::uint8_t tier) {
        words.push_back(static_cast<std::uint64_t>(answer) * 256 + tier);
    };
    for (const Decision& v : answers.verdicts)
        add_sure(v.answer, v.tier);
    for (const Distance& d : answers.distances)
        for (const double x : {d.distance, d.lo, d.hi})
            add(x);
    for (const Impact& impact : answers.impacts) {
        add_sure(impact.answer, impact.tier);
        add(impact.t_free);
        add(impact.t_hit);
    }
    for (const Aabb<double>& box : answers.boxes)
        for (int k = 0; k < 3; ++k) {
            add(box.min[k]);
            add(box.max[k]);
        }
    for (const RayHit& hit : answers.hits)
        words.push_back(hit.hit() ? std::bit_cast<std::uint32_t>(hit.t) : ~std::uint64_t{0});
    return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
}

} // namespace

std::uint64_t answer_hash(const Answers& answers, Ask ask) {
    if (is_kernel_ask(ask))
        return kernel_answer_hash(answers);
    if (ask == Ask::nearest || ask == Ask::closest_points)
        return point_answer_hash(answers, ask);
    if (!is_ray_ask(ask) || ask == Ask::rays_all)
        return digest_of(answers.pairs).hash;
    std::vector<std::uint32_t> words;
    words.reserve(2 * answers.hits.size());
    for (const RayHit& hit : answers.hits) {
        if (ask == Ask::rays_any) {
            words.push_back(hit.hit());
        } else {
            words.push_back(hit.triangle);
            words.push_back(hit.hit() ? std::bit_cast<std::uint32_t>(hit.t) : 0);
        }
    }
    return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
}

} // namespace boxwood::bench
