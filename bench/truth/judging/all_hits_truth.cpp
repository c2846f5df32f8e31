#include "bench/tasks/all_hits.h"
#include "bench/truth/judging/case_text.h"
#include "bench/truth/judging/case_truths.h"
#include "bench/truth/judging/hits_alone.h"
#include "bench/truth/judging/tally.h"
#include "bench/truth/judging/truths.h"
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/roots.h"
#include "kernels/oracle/second_opinion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace boxwood::bench {
namespace {

using Triangles = std::vector<std::uint32_t>;

/// Those that the ray meets at a t that is a float, ascending.
Triangles triangles_met(const RayCase& c, const std::vector<Triangle<float>>& triangles) {
    Triangles met;
    for (std::uint32_t k = c.first; k < c.first + c.count; ++k) {
        const Triangle<float>& t = triangles[k];
        if (!is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c))
            continue; // a miss, as the kernels say
        const auto point = oracle::ray_triangle(c.ray, t);
        require_agreement(point == oracle::second_opinion::ray_triangle(c.ray, t),
                          [&] { return text_of(c) + " and " + text_of(t); });
        if (point && std::isfinite(oracle::nearest_float(point->t)))
            met.push_back(k);
    }
    return met;
}

std::string list_text(std::span<const RayHit> hits, std::uint32_t first) {
    std::string text = fmt::format("{} hits", hits.size());
    for (const RayHit& hit : hits)
        text += fmt::format(", triangle {} at t = {:a}", hit.triangle - first,
                            static_cast<double>(hit.t));
    return text;
}

class AllHitsOfCasesTruth final : public CaseTruth {
  public:
    explicit AllHitsOfCasesTruth(const CaseScene& scene)
        : scene_(scene), cases_(std::get<RayCases>(scene.scene.cases)),
          truths_(cases_.rays, scene.threads,
                  [this](const RayCase& c) { return triangles_met(c, cases_.triangles); }) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        const auto& truths = truths_.of(contender.precision);
        const auto& all = dynamic_cast<const AllHits&>(answers);
        if (all.hits.size() != all.list.size())
            throw std::runtime_error("answers without hits");
        Tally tally(scene_, contender);
        std::size_t next = 0;
        for (std::size_t i = 0; i < truths.size(); ++i) {
            const std::span<const RayHit> said = hits_of(all, i, next);
            if (!truths[i])
                continue;
            const RayCase& c = cases_.rays[i];
            tally.called(0);
            const bool must_hit =
                c.hit == Known::unknown ? !truths[i]->empty() : c.hit == Known::yes;
            if (contender.promise == Promise::never_leaks && must_hit && said.empty())
                tally.leaked(i);
            else
                tally.answered(i, said.empty() ? Answer::no : Answer::yes, must_hit);
            if (contender.promise == Promise::none)
                continue;
            const auto alone = hits_alone(contender.kernel, c, cases_.triangles);
            if (!std::ranges::equal(said, alone) ||
                (contender.promise == Promise::exact && !is_complete(said, *truths[i]))) {
                tally.violated();
                tally.note(i, Worth::broken_promise);
            }
        }
        if (next != all.list.size())
            throw std::runtime_error("the hits are not by ray, or of rays that there are not");
        return tally.finish([&](std::size_t i) {
            const RayCase& c = cases_.rays[i];
            return fmt::format(
                "case {}: said {}, without a tree {}, truth {}; {}, {} triangles; {}", i,
                answer_text(answers, i),
                list_text(hits_alone(contender.kernel, c, cases_.triangles), c.first),
                truth_text(i, contender.precision), case_text(i), c.count,
                replay_command(scene_, contender.name, i));
        });
    }

    std::string case_text(std::size_t i) const override { return text_of(cases_.rays[i]); }
    std::string truth_text(std::size_t i, const std::string& precision) override {
        const auto& truth = truths_.of(precision)[i];
        if (!truth)
            return "none: not finite";
        std::string text = fmt::format("{} hits", truth->size());
        for (const std::uint32_t triangle : *truth)
            text += fmt::format(", {}", triangle - cases_.rays[i].first);
        return text;
    }
    std::string answer_text(const Answers& answers, std::size_t i) const override {
        const auto& all = dynamic_cast<const AllHits&>(answers);
        std::size_t next = 0;
        std::span<const RayHit> said;
        for (std::size_t ray = 0; ray <= i; ++ray)
            said = hits_of(all, ray, next);
        return list_text(said, cases_.rays[i].first);
    }

  private:
    /// Those of the ray that begin at `next`, which is moved behind them.
    static std::span<const RayHit> hits_of(const AllHits& all, std::size_t ray, std::size_t& next) {
        const std::size_t begin = next;
        while (next < all.list.size() && all.list[next].a == ray)
            ++next;
        return std::span(all.hits).subspan(begin, next - begin);
    }

    /// Whether just the triangles of the truth are hit, each once.
    static bool is_complete(std::span<const RayHit> said, const Triangles& truth) {
        Triangles hit;
        for (const RayHit& h : said)
            hit.push_back(h.triangle);
        std::ranges::sort(hit);
        return hit == truth;
    }

    CaseScene scene_;
    const RayCases& cases_;
    Truths<RayCase, Triangles> truths_;
};

} // namespace

std::unique_ptr<CaseTruth> make_all_hits_of_cases_truth(const CaseScene& scene) {
    return std::make_unique<AllHitsOfCasesTruth>(scene);
}

} // namespace boxwood::bench
