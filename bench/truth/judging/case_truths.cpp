#include "bench/truth/judging/case_truths.h"

#include <fmt/format.h>

#include <stdexcept>

namespace boxwood::bench {

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
    if (row.promise == to_string(Promise::never_leaks) && row.bound_violations == 0 && row.n > 0)
        return false; // wrong about triangles on their own, of which it promises nothing
    return row.status == results::Status::wrong && row.promise != to_string(Promise::none);
}

std::string replay_command(const CaseScene& scene, const std::string& kernel, std::size_t i) {
    const SceneSpec& spec = scene.scene.spec;
    std::string pattern;
    for (const char c : kernel)
        pattern += c == '.' ? std::string("[.]") : std::string(1, c);
    std::string command =
        fmt::format("boxwood check --only '^{}/{}/{}$'", spec.generator, scene.task, pattern);
    if (spec.k)
        command += fmt::format(" --k {}", *spec.k);
    command +=
        fmt::format(" --scale {} --n {} --seed {} --case {}", spec.scale, spec.n, spec.seed, i);
    return command;
}

std::string query_command(const ContenderEntry& contender) {
    if (contender.is_peer)
        return "";
    return fmt::format(" (| boxwood query triangles - --kernel {})", contender.name);
}

void require_one_per_case(const Answers& answers, std::size_t cases) {
    if (answers.size() != cases)
        throw std::runtime_error(fmt::format("{} answers to {} cases", answers.size(), cases));
}

std::string text_of(Answer answer) {
    return answer == Answer::yes ? "yes" : answer == Answer::no ? "no" : "maybe";
}

std::string text_of(const Decision& verdict) {
    return verdict.tier == 0 ? text_of(verdict.answer)
                             : fmt::format("{} (tier {})", text_of(verdict.answer), verdict.tier);
}

} // namespace boxwood::bench
