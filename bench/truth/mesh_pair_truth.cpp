#include "bench/truth/mesh_pair_truth.h"

#include "bench/tasks/detail/mesh_pair_answers.h"
#include "bench/truth/judging/witnesses.h"
#include "bench/truth/posed_triangles.h"
#include "kernels/oracle/nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boxwood::bench {
namespace {

class TouchTruth final : public Truth {
  public:
    TouchTruth(const Scene& scene, bool wants_pairs, unsigned threads) : wants_pairs_(wants_pairs) {
        const PosedTriangles mesh = triangles_at(scene.mesh, {});
        for (std::uint32_t i = 0; i < scene.poses.size(); ++i) {
            const std::vector<Pair> pairs =
                touching_pairs(mesh, triangles_at(scene.copy(), scene.poses[i]), threads);
            touches_.push_back(!pairs.empty());
            if (wants_pairs)
                for (const Pair pair : pairs)
                    pairs_.push_back({i, pair.a, pair.b});
        }
    }

    Judgement judge(const Answers& answers, const ContenderEntry&) override {
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = "rational";
        if (wants_pairs_)
            judge_pairs(list_of<PosedPair>(answers), check);
        else
            judge_touches(list_of<std::uint8_t>(answers), check);
        judgement.conclude(true);
        return judgement;
    }

  private:
    void judge_touches(const std::vector<std::uint8_t>& got, results::Check& check) const {
        check.n_checked = check.n_expected = touches_.size();
        check.n_got = got.size();
        if (got.size() != touches_.size()) {
            check.missing = touches_.size();
            check.witness = fmt::format("{} answers for {} poses", got.size(), touches_.size());
            return;
        }
        for (std::size_t i = 0; i < got.size(); ++i) {
            if ((got[i] != 0) == (touches_[i] != 0))
                continue;
            ++(touches_[i] ? check.missing : check.extra);
            if (check.witness.empty())
                check.witness =
                    fmt::format("pose {}: {}", i, touches_[i] ? "a touch is missed" : "none touch");
        }
    }
    void judge_pairs(std::vector<PosedPair> got, results::Check& check) const {
        std::ranges::sort(got);
        check.n_checked = check.n_got = got.size();
        check.n_expected = pairs_.size();
        std::vector<PosedPair> missing, extra;
        std::ranges::set_difference(pairs_, got, std::back_inserter(missing));
        std::ranges::set_difference(got, pairs_, std::back_inserter(extra));
        check.missing = missing.size();
        check.extra = extra.size();
        const std::vector<PosedPair>& wrong = missing.empty() ? extra : missing;
        if (!wrong.empty())
            check.witness =
                fmt::format("pose {}: triangles {} and {} are {}", wrong[0].pose, wrong[0].a,
                            wrong[0].b, missing.empty() ? "apart" : "missing");
    }

    bool wants_pairs_;
    std::vector<std::uint8_t> touches_;
    std::vector<PosedPair> pairs_; ///< ascending; where they are wanted
};

/// What floats may be off by, poses rounded to them included, of the distance and the size.
constexpr double float_slack = 0x1p-20;

/// What mesh_pairs.h allows the bounds where no error is allowed, with room.
constexpr double certified_width = 0x1p-31;

/// Of closest points without a promise. A corner may lie far out before it is moved to where the
/// two are near.
constexpr WitnessErrors usual_witnesses(bool is_float, double size) {
    const double error = is_float ? float_slack : 0x1p-40;
    return {error, error, size};
}

class MeshDistanceTruth final : public Truth {
  public:
    MeshDistanceTruth(const Scene& scene, unsigned threads)
        : scene_(scene), mesh_(triangles_at(scene.mesh, {})),
          least_(least_distances(scene, threads)), size_(size_of(mesh_)) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = "rational";
        check.max_abs_err = check.max_rel_err = 0;
        const std::vector<PosedDistance>& got = list_of<PosedDistance>(answers);
        check.n_expected = scene_.poses.size();
        check.n_got = got.size();
        if (got.size() != scene_.poses.size()) {
            check.missing = scene_.poses.size();
            check.witness = fmt::format("{} answers for {} poses", got.size(), scene_.poses.size());
            judgement.conclude(true);
            return judgement;
        }
        for (std::size_t i = 0; i < got.size(); ++i)
            judge_pose(i, got[i], contender, check);
        judgement.conclude(false);
        return judgement;
    }

  private:
    void judge_pose(std::size_t i, const PosedDistance& got, const ContenderEntry& contender,
                    results::Check& check) {
        ++check.n_checked;
        const auto complain = [&](std::uint64_t& count, const std::string& what) {
            ++count;
            if (check.witness.empty())
                check.witness = fmt::format("pose {}: {}", i, what);
        };
        if (got.triangles.a >= mesh_.size() || got.triangles.b >= scene_.copy().triangles.size())
            return complain(check.missing, "no triangles are named");
        if (!(std::isfinite(got.hi) && got.lo <= got.distance && got.distance <= got.hi))
            return complain(check.missing,
                            fmt::format("{} is no distance between its bounds {} and {}",
                                        got.distance, got.lo, got.hi));
        const Triangle<double> b = triangle_at(scene_.copy(), got.triangles.b, scene_.poses[i]);
        const mpq_class squared = oracle::nearest(mesh_[got.triangles.a], b).squared;
        const double named = std::sqrt(squared.get_d());
        const auto [truth, lo] = least_[i];
        const double error = std::abs(got.distance - truth);
        check.max_abs_err = std::max(check.max_abs_err, error);
        if (truth > 0)
            check.max_rel_err = std::max(check.max_rel_err, error / truth);
        // Too far is unsafe: something nearer is there. Too near is not, but wrong.
        const bool is_certified = contender.promise == Promise::certified;
        const double slack = !is_certified && contender.precision == "f32"
                                 ? float_slack * (truth + size_)
                                 : 1e-9 * truth + 1e-13 * size_;
        const double allowed = contender.relative_width * got.hi;
        if (got.distance > truth + slack + allowed)
            complain(check.missing, fmt::format("said to be {} apart, and a pair is {} apart",
                                                got.distance, truth));
        else if (named > got.distance + slack || (is_certified && got.distance > named + slack))
            complain(check.extra, fmt::format("said to be {} apart by triangles that are {} apart",
                                              got.distance, named));
        else if (is_certified && (got.lo > truth * (1 + 0x1p-50) || got.hi < lo * (1 - 0x1p-50))) {
            ++check.bound_violations;
            complain(check.extra, fmt::format("[{}, {}] does not hold {}", got.lo, got.hi, truth));
        } else if (const double width = std::max(contender.relative_width, certified_width);
                   is_certified && !are_narrow(got.lo, got.hi, width)) {
            ++check.bound_violations;
            complain(check.extra,
                     fmt::format("[{}, {}] is wider than {} of it", got.lo, got.hi, width));
        } else if (const std::string fault =
                       fault_of_points(got, scene_.poses[i], b, sgn(squared) == 0, contender);
                   !fault.empty())
            complain(check.extra, fault);
    }

    /// named_touch: whether the triangles that are named do.
    std::string fault_of_points(const PosedDistance& got, const RigidTransform<double>& pose,
                                const Triangle<double>& b, bool named_touch,
                                const ContenderEntry& contender) const {
        const bool is_certified = contender.promise == Promise::certified;
        if (!got.points)
            return is_certified ? "no closest points are given" : "";
        const double width = is_certified ? 0x1p-32 * got.distance : 0;
        return witness_fault(got.points->on_mesh, got.points->on_copy, mesh_[got.triangles.a], b,
                             got.distance - width, got.distance + width,
                             is_certified ? promised_witnesses(named_touch)
                                          : usual_witnesses(contender.precision == "f32",
                                                            size_ + length(pose.translation)));
    }

    const Scene& scene_;
    PosedTriangles mesh_;
    std::vector<NearestTriangles::Least> least_; ///< by pose
    double size_;
};

/// Of the poses: on which side of a tolerance. Nearer to it than 2^-30 of it both answers are
/// right.
class WithinTruth final : public Truth {
  public:
    WithinTruth(const Scene& scene, double tolerance, unsigned threads)
        : tolerance_(tolerance), least_(least_distances(scene, threads)) {}

    Judgement judge(const Answers& answers, const ContenderEntry&) override {
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = "rational";
        const std::vector<std::uint8_t>& got = list_of<std::uint8_t>(answers);
        check.n_checked = check.n_expected = least_.size();
        check.n_got = got.size();
        if (got.size() != least_.size()) {
            check.missing = least_.size();
            check.witness = fmt::format("{} answers for {} poses", got.size(), least_.size());
        } else {
            for (std::size_t i = 0; i < got.size(); ++i)
                judge_pose(i, got[i] != 0, check);
        }
        judgement.conclude(true);
        return judgement;
    }

  private:
    void judge_pose(std::size_t i, bool is_near, results::Check& check) const {
        const auto [distance, lo] = least_[i];
        const bool must = distance <= tolerance_ * (1 - 0x1p-30);
        const bool must_not = lo > tolerance_ * (1 + 0x1p-30);
        if (is_near ? !must_not : !must)
            return;
        ++(is_near ? check.extra : check.missing);
        if (check.witness.empty())
            check.witness = fmt::format("pose {}: said to be {} {} apart, and they are {}", i,
                                        is_near ? "at most" : "more than", tolerance_, distance);
    }

    double tolerance_;
    std::vector<NearestTriangles::Least> least_; ///< by pose
};

} // namespace

std::unique_ptr<Truth> make_touch_truth(const Scene& scene, unsigned threads) {
    return std::make_unique<TouchTruth>(scene, false, threads);
}
std::unique_ptr<Truth> make_touching_truth(const Scene& scene, unsigned threads) {
    return std::make_unique<TouchTruth>(scene, true, threads);
}
std::unique_ptr<Truth> make_mesh_distance_truth(const Scene& scene, unsigned threads) {
    return std::make_unique<MeshDistanceTruth>(scene, threads);
}
std::unique_ptr<Truth> make_within_truth(const Scene& scene, double tolerance, unsigned threads) {
    return std::make_unique<WithinTruth>(scene, tolerance, threads);
}

} // namespace boxwood::bench
