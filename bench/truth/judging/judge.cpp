#include "bench/truth/judging/judge.h"

#include "bench/truth/judging/judges.h"

#include <fmt/format.h>

#include <stdexcept>

namespace boxwood::bench {
namespace {

Judgement with_names(Judgement judgement, const Scene& scene, Ask ask, const std::string& rung) {
    results::KernelRow& row = judgement.kernel;
    const HardCaseFamily* family = find_hard_case_family(scene.spec.generator);
    row.family = family ? std::string(family->name) : "typical";
    row.panel = to_string(panel_of(scene));
    row.task = to_string(ask);
    row.kernel = rung;
    return judgement;
}

/// Fills in what all kinds of answers have in common.
class NamedJudge final : public Judge {
  public:
    NamedJudge(const Scene& scene, Ask ask, std::unique_ptr<Judge> judge)
        : scene_(scene), ask_(ask), judge_(std::move(judge)) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        return with_names(judge_->judge(answers, contender), scene_, ask_, contender.name);
    }
    std::string case_text(std::size_t i) const override { return judge_->case_text(i); }
    std::string truth_text(std::size_t i, const std::string& precision) override {
        return judge_->truth_text(i, precision);
    }
    std::string answer_text(const Answers& answers, std::size_t i) const override {
        return judge_->answer_text(answers, i);
    }

  private:
    const Scene& scene_;
    Ask ask_;
    std::unique_ptr<Judge> judge_;
};

std::unique_ptr<Judge> judge_of(const Scene& scene, Ask ask, unsigned threads) {
    switch (ask) {
    case Ask::triangle_triangle:
    case Ask::ray_box:
    case Ask::obb_obb:
        return verdict_judge(scene, ask, threads);
    case Ask::ray_triangle:
        return ray_judge(scene, threads);
    case Ask::vertex_face:
    case Ask::edge_edge:
        return impact_judge(scene, threads);
    case Ask::box_fit:
        return fit_judge(scene, threads);
    default:
        return distance_judge(scene, ask, threads);
    }
}

} // namespace

std::unique_ptr<Judge> make_judge(const Scene& scene, Ask ask, unsigned threads) {
    if (!fits(scene.cases, ask))
        throw std::invalid_argument(
            fmt::format("{} has no cases to ask for {}", scene.name, to_string(ask)));
    return std::make_unique<NamedJudge>(scene, ask, judge_of(scene, ask, threads));
}

bool fits(const Cases& cases, Ask ask) {
    switch (ask) {
    case Ask::triangle_triangle:
    case Ask::triangle_distance:
    case Ask::segment_segment:
    case Ask::point_triangle:
    case Ask::point_segment:
        return std::holds_alternative<std::vector<TrianglePairCase>>(cases);
    case Ask::ray_triangle:
        return std::holds_alternative<RayCases>(cases);
    case Ask::ray_box:
        return std::holds_alternative<std::vector<RayBoxCase>>(cases);
    case Ask::vertex_face:
    case Ask::edge_edge: {
        const auto* motions = std::get_if<MotionCases>(&cases);
        return motions && (motions->kind == MotionKind::vertex_face) == (ask == Ask::vertex_face);
    }
    case Ask::obb_obb:
        return std::holds_alternative<std::vector<ObbPairCase>>(cases);
    case Ask::box_fit:
        return std::holds_alternative<std::vector<FitCase>>(cases);
    default:
        return false;
    }
}

Cases only_case(const Cases& cases, std::size_t i) {
    const auto keep = [i](auto& list) {
        const auto kept = list.at(i);
        list.assign(1, kept);
    };
    Cases one = cases;
    std::visit(
        [&]<class Held>(Held& held) {
            if constexpr (std::is_same_v<Held, RayCases>)
                keep(held.rays);
            else if constexpr (std::is_same_v<Held, MotionCases>)
                keep(held.motions);
            else if constexpr (requires { held.at(i); })
                keep(held);
        },
        one);
    return one;
}

Panel panel_of(const Scene& scene) {
    const HardCaseFamily* family = find_hard_case_family(scene.spec.generator);
    if (!family)
        return Panel::generic;
    const int scale = scene.spec.scale;
    const bool is_extreme =
        scale != 0 && (scale == family->scale_min || scale == family->scale_max);
    return is_extreme ? Panel::degenerate : family->panel;
}

bool breaks_promise(const results::KernelRow& row) {
    return row.status == "wrong" && row.promise != to_string(Promise::none);
}

std::string replay_command(const Scene& scene, Ask ask, const std::string& rung, std::size_t i) {
    std::string pattern;
    for (const char c : rung)
        pattern += c == '.' ? std::string("[.]") : std::string(1, c);
    std::string command = fmt::format("boxwood check --only '^{}/{}/{}$'", scene.spec.generator,
                                      to_string(ask), pattern);
    if (scene.spec.k)
        command += fmt::format(" --k {}", *scene.spec.k);
    command += fmt::format(" --scale {} --n {} --seed {} --case {}", scene.spec.scale, scene.spec.n,
                           scene.spec.seed, i);
    return command;
}

std::string query_command(const ContenderEntry& contender, Ask ask) {
    if (contender.is_peer)
        return "";
    return fmt::format(" (| boxwood query triangles - --kernel {}{})", contender.name,
                       ask == Ask::triangle_distance ? " --distance" : "");
}

void require_one_per_case(std::size_t answers, std::size_t cases) {
    if (answers != cases)
        throw std::runtime_error(fmt::format("{} answers to {} cases", answers, cases));
}

std::string text_of(Answer answer) {
    return answer == Answer::yes ? "yes" : answer == Answer::no ? "no" : "maybe";
}

} // namespace boxwood::bench
