#include "bench/truth/judging/case_text.h"
#include "bench/truth/judging/case_truths.h"
#include "bench/truth/judging/tally.h"
#include "bench/truth/judging/truths.h"
#include "kernels/triangle_distance/distance_kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace boxwood::bench {
namespace {

/// An interval wider than this part of the distance says little.
constexpr double wide_interval = 0x1p-16;

/// The distance of two convex shapes, signed or not, against [lo, hi] of the case.
class ShapeDistanceTruth final : public CaseTruth {
  public:
    ShapeDistanceTruth(const CaseScene& scene, bool is_signed)
        : scene_(scene), cases_(std::get<std::vector<ShapePairCase>>(scene.scene.cases)),
          is_signed_(is_signed) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        require_one_per_case(answers, cases_.size());
        const std::vector<Distance>& distances = list_of<Distance>(answers);
        Tally tally(scene_, contender);
        for (std::size_t i = 0; i < cases_.size(); ++i) {
            const std::optional<ShapePairCase> known = known_of(i, contender.precision);
            if (!known)
                continue;
            const ShapePairCase& c = *known;
            const Distance& said = distances[i];
            tally.called(said.tier);
            const double off = std::max({c.lo - said.distance, said.distance - c.hi, 0.0});
            tally.error(std::numeric_limits<double>::quiet_NaN(),
                        off / (size_of(c.a) + size_of(c.b)));
            if (contender.promise == Promise::none) {
                tally.note(i, unpromised(tally, said, off, c, contender.precision));
            } else if (keeps_promise(said, c)) {
                if (said.hi - said.lo > wide_interval * std::abs(said.distance))
                    tally.vague(i);
                tally.note(i, Worth::within_bound);
            } else {
                tally.violated();
                tally.note(i, Worth::broken_promise);
            }
        }
        return tally.finish([&](std::size_t i) {
            return fmt::format("case {}: said {}, truth {}; {}; {}", i, answer_text(answers, i),
                               truth_text(i, contender.precision), case_text(i),
                               replay_command(scene_, contender.name, i));
        });
    }

    std::string case_text(std::size_t i) const override { return text_of(cases_[i]); }
    std::string truth_text(std::size_t i, const std::string& precision) override {
        const std::optional<ShapePairCase> c = known_of(i, precision);
        return c ? fmt::format("in [{:a}, {:a}]", c->lo, c->hi) : "none: not finite, or not known";
    }
    std::string answer_text(const Answers& answers, std::size_t i) const override {
        const Distance& d = list_of<Distance>(answers)[i];
        if (d.lo == d.distance && d.hi == d.distance)
            return fmt::format("{:a}", d.distance);
        return fmt::format("{:a} in [{:a}, {:a}]", d.distance, d.lo, d.hi);
    }

  private:
    /// The case as a kernel of this precision reads it; nothing if it is not judged.
    std::optional<ShapePairCase> known_of(std::size_t i, const std::string& precision) const {
        ShapePairCase c = cases_[i];
        if (precision == "f32")
            c = rounded_to_floats(c).value_or(c);
        if (!is_finite(c))
            return std::nullopt;
        if (!is_signed_) {
            c.lo = std::max(c.lo, 0.0);
            c.hi = std::max(c.hi, 0.0);
        }
        return c;
    }
    static bool keeps_promise(const Distance& said, const ShapePairCase& c) {
        return said.lo <= said.distance && said.distance <= said.hi && said.lo <= c.hi &&
               said.hi >= c.lo;
    }

    /// NaN is how a peer says that it cannot take the case.
    static Worth unpromised(Tally& tally, const Distance& said, double off, const ShapePairCase& c,
                            const std::string& precision) {
        if (std::isnan(said.distance)) {
            tally.undecided();
            return Worth::conservative;
        }
        if (off <= peers_error(precision) * (size_of(c.a) + size_of(c.b)))
            return Worth::within_bound;
        said.distance < c.lo ? tally.too_small() : tally.too_large();
        return Worth::wrong;
    }

    CaseScene scene_;
    const std::vector<ShapePairCase>& cases_;
    bool is_signed_;
};

} // namespace

std::unique_ptr<CaseTruth> make_shape_distance_truth(const CaseScene& scene) {
    return std::make_unique<ShapeDistanceTruth>(scene, false);
}
std::unique_ptr<CaseTruth> make_signed_shape_distance_truth(const CaseScene& scene) {
    return std::make_unique<ShapeDistanceTruth>(scene, true);
}

} // namespace boxwood::bench
