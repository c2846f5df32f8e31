#include "bench/truth/judging/distance_truth.h"

#include "bench/truth/judging/case_text.h"
#include "bench/truth/judging/tally.h"
#include "bench/truth/judging/truths.h"
#include "bench/truth/judging/witnesses.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/roots.h"
#include "kernels/oracle/second_opinion.h"
#include "kernels/triangle_distance/distance_kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace boxwood::bench {
namespace {

/// What a kernel without a bound may be off: 64 u L, and a few of the smallest numbers.
double tolerance(const TrueDistance& truth, const std::string& precision) {
    const bool floats = precision == "f32";
    return 64 * (floats ? 0x1p-24 : 0x1p-53) * truth.extent +
           4 * (floats ? 0x1p-149 : std::numeric_limits<double>::denorm_min());
}

/// Largest errors and bounds by decade of L/d.
class Decades {
  public:
    explicit Decades(bool has_bound) : has_bound_(has_bound) {}

    void add(const Distance& said, const TrueDistance& truth, double relative_error) {
        const double condition = truth.extent / truth.nearest;
        if (!std::isfinite(condition) || !(condition > 0))
            return;
        const double decade = std::floor(std::log10(condition));
        results::ConditionRow& row = rows_[decade];
        row.log10_condition = decade;
        ++row.n;
        row.max_rel_err = std::fmax(row.max_rel_err, relative_error);
        if (has_bound_)
            row.bound = std::fmax(row.bound, (said.hi - said.lo) / truth.nearest);
    }
    std::vector<results::ConditionRow> rows() const {
        std::vector<results::ConditionRow> rows;
        for (const auto& [decade, row] : rows_)
            rows.push_back(row);
        return rows;
    }

  private:
    bool has_bound_;
    std::map<double, results::ConditionRow> rows_;
};

class DistanceTruth final : public CaseTruth {
  public:
    DistanceTruth(const CaseScene& scene, TrueDistance (*measure)(const TrianglePairCase&))
        : scene_(scene), cases_(std::get<std::vector<TrianglePairCase>>(scene.scene.cases)),
          truths_(cases_, scene.threads, measure) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        require_one_per_case(answers, cases_.size());
        const std::vector<Distance>& distances = list_of<Distance>(answers);
        const auto& truths = truths_.of(contender.precision);
        Tally tally(scene_, contender);
        Decades decades(contender.promise != Promise::none);
        for (std::size_t i = 0; i < cases_.size(); ++i) {
            if (!truths[i])
                continue;
            const Distance& said = distances[i];
            const TrueDistance& truth = *truths[i];
            tally.called(said.tier);
            note_error(tally, decades, said, truth, contender.precision);
            tally.note(i, contender.promise == Promise::none
                              ? unpromised(tally, said, truth, contender.precision)
                              : promised(tally, said, truth, contender));
        }
        Judgement judgement = tally.finish([&](std::size_t i) {
            return fmt::format("case {}: said {}, truth {:a}; {}; {}", i, answer_text(answers, i),
                               truths[i]->nearest, text_of(truths_.as_read(i, contender.precision)),
                               replay_command(scene_, contender.name, i));
        });
        judgement.conditions = decades.rows();
        return judgement;
    }

    std::string case_text(std::size_t i) const override { return text_of(cases_[i]); }
    std::string truth_text(std::size_t i, const std::string& precision) override {
        const auto& truth = truths_.of(precision)[i];
        return truth ? fmt::format("{:a}", truth->nearest) : "none: not finite";
    }
    std::string answer_text(const Answers& answers, std::size_t i) const override {
        const Distance& d = list_of<Distance>(answers)[i];
        if (d.lo == d.distance && d.hi == d.distance)
            return fmt::format("{:a}", d.distance);
        return fmt::format("{:a} in [{:a}, {:a}] (tier {})", d.distance, d.lo, d.hi, d.tier);
    }

  private:
    static void note_error(Tally& tally, Decades& decades, const Distance& said,
                           const TrueDistance& truth, const std::string& precision) {
        if (!(std::isfinite(said.distance) && truth.nearest > 0))
            return;
        // Roots agree to far less than the error of any kernel of floats.
        const double ulps = oracle::ulps_off(said.distance, truth.squared);
        const double relative = std::abs(said.distance - truth.nearest) / truth.nearest;
        tally.error(precision == "f32" ? ulps * 0x1p-29 : ulps, relative);
        decades.add(said, truth, relative);
    }

    /// NaN is how a peer says that it cannot take the case.
    static Worth unpromised(Tally& tally, const Distance& said, const TrueDistance& truth,
                            const std::string& precision) {
        if (std::isnan(said.distance)) {
            tally.undecided();
            return Worth::conservative;
        }
        const double limit = tolerance(truth, precision);
        if (!(std::abs(said.distance - truth.nearest) <= limit)) {
            said.distance < truth.nearest ? tally.too_small() : tally.too_large();
            return Worth::wrong;
        }
        return said.distance == truth.nearest ? Worth::exact : Worth::within_bound;
    }

    /// As Distance::point_a says. Beyond the range of doubles nothing is.
    static bool has_witnesses(const Distance& said, const TrueDistance& truth) {
        return witness_fault(said.point_a, said.point_b, truth.a, truth.b, said.lo, said.hi,
                             promised_witnesses(sgn(truth.squared) == 0))
            .empty();
    }

    /// Squares are compared, never roots. Zero is said if and only if the two touch (or the true
    /// distance is less than every positive double).
    static Worth promised(Tally& tally, const Distance& said, const TrueDistance& truth,
                          const ContenderEntry& contender) {
        const bool encloses = said.lo >= 0 && said.lo <= said.distance &&
                              said.distance <= said.hi &&
                              oracle::compare(said.lo, truth.squared) <= 0 &&
                              oracle::compare(said.hi, truth.squared) >= 0;
        const bool zero_is_right = truth.nearest == 0 || said.distance != 0;
        const bool touch_is_zero = sgn(truth.squared) != 0 || said.distance == 0;
        const bool is_rounded = tally.promise() != Promise::exact || truth.nearest == 0 ||
                                std::abs(oracle::ulps_off(said.distance, truth.squared)) <= 1;
        const bool is_narrow = tally.promise() == Promise::exact
                                   ? said.hi <= oracle::next_above(said.lo)
                                   : contender.relative_width == 0 ||
                                         are_narrow(said.lo, said.hi, contender.relative_width);
        if (encloses && zero_is_right && touch_is_zero && is_rounded && is_narrow &&
            (!contender.has_witnesses || has_witnesses(said, truth)))
            return said.distance == truth.nearest ? Worth::exact : Worth::within_bound;
        tally.violated();
        return Worth::broken_promise;
    }

    CaseScene scene_;
    const std::vector<TrianglePairCase>& cases_;
    Truths<TrianglePairCase, TrueDistance> truths_;
};

} // namespace

TrueDistance true_distance(mpq_class squared, std::initializer_list<Vec3<double>> a,
                           std::initializer_list<Vec3<double>> b) {
    const std::vector<Vec3<double>> points_a(a), points_b(b);
    require_agreement(oracle::second_opinion::squared_distance(points_a, points_b) == squared,
                      [&] { return text_of(points_a) + ',' + text_of(points_b); });
    Aabb<double> box;
    for (const auto* points : {&points_a, &points_b})
        for (const Vec3<double>& p : *points)
            box.extend(p);
    const Vec3<double> size = box.max - box.min;
    const double nearest = oracle::nearest_sqrt(squared);
    const auto triangle = [](const std::vector<Vec3<double>>& points) {
        return Triangle<double>{points[0], points[points.size() > 1 ? 1 : 0], points.back()};
    };
    return {std::move(squared), nearest, std::max({size.x, size.y, size.z}), triangle(points_a),
            triangle(points_b)};
}

std::unique_ptr<CaseTruth> make_distance_truth(const CaseScene& scene,
                                               TrueDistance (*measure)(const TrianglePairCase&)) {
    return std::make_unique<DistanceTruth>(scene, measure);
}

} // namespace boxwood::bench
