#include "bench/running/check.h"

#include "bench/io/bad_input.h"
#include "bench/plan/cell_name.h"
#include "bench/running/isolated.h"
#include "bench/tasks/kernels/kernels.h"
#include "bench/tasks/ours.h"
#include "bench/truth/judging/judge.h"
#include "bench/truth/truth.h"
#include "trees/layout.h"
#include "trees/tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

namespace boxwood::bench {
namespace {

unsigned all_cores() { return std::max(1u, std::thread::hardware_concurrency()); }

std::regex regex_of(const std::string& only) {
    try {
        return std::regex(only);
    } catch (const std::regex_error& error) {
        throw BadInput(
            fmt::format("--only \"{}\" is not a regular expression: {}", only, error.what()));
    }
}

std::string address(std::string_view family, Ask ask, const std::string& rung) {
    return fmt::format("{}/{}/{}", family, to_string(ask), rung);
}

/// The least time of a query: the first one if it takes the whole budget, else of as many as fit.
double least_ns(Contender& contender, Answers& answers, double budget_ns) {
    using Clock = std::chrono::steady_clock;
    double least = results::missing, spent = 0;
    do {
        const auto start = Clock::now();
        contender.query(answers);
        const double ns = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
        least = std::fmin(least, ns);
        spent += ns;
    } while (spent < budget_ns);
    return least;
}

/// Builds, answers, and times the query. Peers in a process of their own: some crash on such input.
Outcome outcome_of(const ContenderEntry& contender, const Job& job, double budget_ns) {
    const auto work = [&](Outcome& outcome) {
        const KeepFloatingPointMode keep;
        const std::unique_ptr<Contender> instance = contender.make(job);
        instance->build();
        instance->query(outcome.answers);
        outcome.ns = least_ns(*instance, outcome.answers, budget_ns);
    };
    if (contender.is_peer)
        return isolated(work);
    Outcome outcome;
    work(outcome);
    return outcome;
}

bool is_box_family(const Cases& cases) { return std::holds_alternative<BoxCases>(cases); }

/// What a time is divided by: cases, or pairs and boxes.
std::uint64_t calls_of(const Scene& scene) {
    const auto* boxes = std::get_if<BoxCases>(&scene.cases);
    return boxes ? std::max<std::uint64_t>(boxes->n_pairs, boxes->boxes.size())
                 : n_cases(scene.cases);
}

std::vector<Ask> asks_of(const Cases& cases) {
    std::vector<Ask> fitting;
    for (const AskEntry& entry : asks())
        if (is_kernel_ask(entry.task) ? fits(cases, entry.task)
                                      : entry.task == Ask::pairs && is_box_family(cases))
            fitting.push_back(entry.task);
    return fitting;
}

} // namespace

std::vector<ContenderEntry> contenders_of(Ask ask) {
    std::vector<ContenderEntry> all;
    if (is_kernel_ask(ask))
        for (const KernelInfo& rung : rungs(ask))
            all.push_back(rung_contender(ask, rung.name));
    else
        for (const BuilderEntry& builder : builders())
            for (const LayoutEntry& layout : layouts()) {
                all.push_back(our_contender({.builder = std::string(builder.name),
                                             .settings = {},
                                             .layout = std::string(layout.name)},
                                            ask));
                all.back().promise = Promise::exact;
            }
    for (const ContenderEntry& contender : peers_that_answer(ask))
        all.push_back(contender);
    return all;
}

std::vector<SceneSpec> check_scenes(const CheckOptions& options) {
    const std::regex only = regex_of(options.only);
    const auto is_meant = [&](const HardCaseFamily& family) {
        return std::ranges::any_of(asks(), [&](const AskEntry& entry) {
            return (is_kernel_ask(entry.task) || entry.task == Ask::pairs) &&
                   std::ranges::any_of(contenders_of(entry.task), [&](const ContenderEntry& c) {
                       return std::regex_search(address(family.name, entry.task, c.name), only);
                   });
        });
    };
    std::vector<SceneSpec> scenes;
    bool is_any_meant = false;
    for (const HardCaseFamily& family : hard_case_families()) {
        if (!is_meant(family) || (family.reads_file && options.ccd.empty()))
            continue;
        is_any_meant = true;
        SceneSpec spec;
        spec.generator = family.name;
        spec.n = options.n;
        spec.seed = options.seed;
        spec.k = options.k;
        if (family.reads_file)
            spec.file = options.ccd;
        const int middle = std::clamp(0, family.scale_min, family.scale_max);
        std::set<int> scales{options.scale.value_or(middle)};
        if (!options.scale && !options.is_quick)
            scales.insert({family.scale_min, family.scale_max});
        const bool has_k = !options.k || (!family.k_meaning.empty() && *options.k >= family.k_min &&
                                          *options.k <= family.k_max);
        for (const int scale : scales) {
            spec.scale = scale;
            if (has_k && scale >= family.scale_min && scale <= family.scale_max)
                scenes.push_back(spec);
        }
    }
    if (scenes.empty())
        throw BadInput(
            is_any_meant
                ? std::string("--k or --scale is out of range for the families that --only names "
                              "(`boxwood list families` tells the ranges)")
                : fmt::format("--only \"{}\" names no family/task/rung; see `boxwood list "
                              "families` and `boxwood list kernels`{}",
                              options.only,
                              options.ccd.empty() ? " (families of files need --ccd DIR)" : ""));
    return scenes;
}

CheckRun::CheckRun(const CheckOptions& options, const results::Env& env, ContendersOf contenders)
    : options_(options), contenders_(std::move(contenders)), only_(regex_of(options.only)),
      budget_ns_(options.is_quick ? 2e5 : 1e6), record_(env, "boxwood check") {}

std::vector<ContenderEntry> CheckRun::chosen(const std::string& family, Ask ask) const {
    std::vector<ContenderEntry> all = contenders_(ask);
    std::erase_if(all, [&](const ContenderEntry& c) {
        return !std::regex_search(address(family, ask, c.name), only_);
    });
    return all;
}

void CheckRun::judge(const Scene& scene, const std::function<void(Ask)>& said) {
    std::vector<std::pair<Ask, std::vector<ContenderEntry>>> work;
    std::string words;
    for (const Ask ask : asks_of(scene.cases)) {
        work.emplace_back(ask, chosen(scene.spec.generator, ask));
        words += fmt::format("{}{}", words.empty() ? "" : ",", to_string(ask));
    }
    const std::uint32_t scene_id = record_.add_scene(scene, words);
    for (const auto& [ask, contenders] : work) {
        if (contenders.empty())
            continue;
        said(ask);
        if (is_kernel_ask(ask))
            judge_cases(scene, scene_id, ask, contenders);
        else
            judge_pairs(scene, scene_id, contenders);
    }
}

/// work(contender, answers) gives the judgement of one cell.
template <class Work>
void CheckRun::record_cell(const Scene& scene, std::uint32_t scene_id, Ask ask,
                           const ContenderEntry& contender, const Work& work) {
    const Job job{&scene, ask, "serial", 1};
    const std::string name =
        format_cell_name({scene.name, scene.spec.n, scene.spec.seed, std::string(to_string(ask)),
                          contender.name, contender.precision, "serial", 1});
    const results::Cell cell = record_.cell(name, scene, scene_id, ask, contender, "serial", 1);
    Judgement judgement;
    judgement.check.witness =
        contender.unsupported ? contender.unsupported(job).value_or("") : std::string();
    judgement.kernel.status = judgement.check.status = "unsupported";
    if (judgement.check.witness.empty()) {
        try {
            const Outcome outcome = outcome_of(contender, job, budget_ns_);
            if (!outcome.failure.empty())
                throw std::runtime_error(outcome.failure);
            judgement = work(contender, outcome.answers);
            judgement.check.result_hash = answer_hash(outcome.answers, ask);
            judgement.kernel.ns_per_call =
                outcome.ns / static_cast<double>(std::max<std::uint64_t>(1, calls_of(scene)));
        } catch (const InvalidBox& error) { // the promised answer to a box that is none
            judgement.check.witness = error.what();
        } catch (const std::exception& error) {
            judgement.kernel.status = judgement.check.status = "wrong";
            judgement.check.witness = error.what();
        }
    }
    results::KernelRow& row = judgement.kernel;
    row.family = scene.spec.generator;
    row.panel = to_string(panel_of(scene));
    row.task = to_string(ask);
    row.kernel = contender.name;
    row.promise = to_string(contender.promise);
    row.witness = judgement.check.witness;
    judgement.check.cell_id = cell.cell_id;
    record_.out.cells.push_back(cell);
    record_.out.checks.push_back(judgement.check);
    record_.add(std::move(judgement), cell.cell_id);
}

void CheckRun::judge_cases(const Scene& scene, std::uint32_t scene_id, Ask ask,
                           const std::vector<ContenderEntry>& contenders) {
    const std::unique_ptr<Judge> judge = make_judge(scene, ask, all_cores());
    std::string said;
    for (const ContenderEntry& contender : contenders)
        record_cell(
            scene, scene_id, ask, contender, [&](const ContenderEntry& c, const Answers& answers) {
                Judgement judgement = judge->judge(answers, c);
                if (options_.one)
                    said += fmt::format("  {} ({}): {}; truth {}: {}\n", c.name, c.precision,
                                        judge->answer_text(answers, 0),
                                        judge->truth_text(0, c.precision), judgement.kernel.status);
                return judgement;
            });
    if (options_.one)
        details_ += fmt::format("{}/{}, case {}\n{}\n{}", scene.name, to_string(ask), *options_.one,
                                judge->case_text(0), said);
}

/// Against brute force, and that against the number of pairs that is known.
void CheckRun::judge_pairs(const Scene& scene, std::uint32_t scene_id,
                           const std::vector<ContenderEntry>& contenders) {
    const std::unique_ptr<Truth> truth = make_truth(scene, Ask::pairs, all_cores());
    const std::uint64_t known = std::get<BoxCases>(scene.cases).n_pairs;
    for (const ContenderEntry& contender : contenders)
        record_cell(scene, scene_id, Ask::pairs, contender,
                    [&](const ContenderEntry&, const Answers& answers) {
                        Judgement judgement;
                        judgement.check = truth->check(answers);
                        if (judgement.check.n_expected != known)
                            throw std::logic_error(
                                fmt::format("brute force finds {} pairs, {} are known",
                                            judgement.check.n_expected, known));
                        judgement.kernel.status = judgement.check.status;
                        judgement.kernel.n = judgement.kernel.tier_0 = calls_of(scene);
                        judgement.kernel.false_pos = judgement.check.extra;
                        judgement.kernel.false_neg = judgement.check.missing;
                        return judgement;
                    });
}

} // namespace boxwood::bench
