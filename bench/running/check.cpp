#include "bench/running/check.h"

#include "bench/io/bad_input.h"
#include "bench/plan/cell_name.h"
#include "bench/running/isolated.h"
#include "bench/truth/judging/case_truths.h"
#include "bench/truth/truth.h"
#include "trees/tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

namespace boxwood::bench {
namespace {

/// True as well where a scene's boxes are made of its cases.
bool is_bad_box(const Scene& scene, std::size_t index) {
    if (scene.boxes.empty())
        return true;
    try {
        require_valid(scene.boxes[std::min(index, scene.boxes.size() - 1)], index);
        return false;
    } catch (const InvalidBox&) {
        return true;
    }
}

unsigned all_cores() { return std::max(1u, std::thread::hardware_concurrency()); }

/// A quick check takes the ends of the range of scales with fewer cases.
std::size_t n_of_quick_extremes(std::size_t n) { return (n + 9) / 10; }

std::string address(std::string_view family, const Task& task, const std::string& contender) {
    return fmt::format("{}/{}/{}", family, task.name(), contender);
}

/// The least time of a query: the first one if it takes the whole budget, else of as many as fit.
double min_query_ns(Contender& contender, Answers& answers, double budget_ns) {
    using Clock = std::chrono::steady_clock;
    double min_ns = results::missing, spent = 0;
    do {
        const auto start = Clock::now();
        contender.query(answers);
        const double ns = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
        min_ns = std::fmin(min_ns, ns);
        spent += ns;
    } while (spent < budget_ns);
    return min_ns;
}

/// Builds, answers, and times the query. Peers in a process of their own: some crash on such input.
Outcome outcome_of(const ContenderEntry& contender, const Job& job, double budget_ns,
                   Answers& answers) {
    const auto work = [&](Answers& to) {
        const KeepFloatingPointMode keep;
        const std::unique_ptr<Contender> instance = contender.make(job);
        instance->build();
        return min_query_ns(*instance, to, budget_ns);
    };
    if (contender.is_peer)
        return isolated(answers, work);
    return {work(answers), ""};
}

} // namespace

std::vector<ContenderEntry> contenders_of(const Task& task) {
    std::vector<ContenderEntry> all = task.contenders_on_cases();
    for (const ContenderEntry& contender : peers_that_answer(task.name()))
        if (contender.runs_on != RunsOn::device)
            all.push_back(contender);
    return all;
}

std::vector<SceneSpec> check_scenes(const CheckOptions& options) {
    const Pattern only(options.only);
    std::vector<std::pair<const Task*, std::vector<ContenderEntry>>> all;
    for (const Task* task : tasks())
        if (!task->contenders_on_cases().empty())
            all.emplace_back(task, contenders_of(*task));
    const auto is_meant = [&](const HardCaseFamily& family) {
        return std::ranges::any_of(all, [&](const auto& of_task) {
            return std::ranges::any_of(of_task.second, [&](const ContenderEntry& c) {
                return only.is_in(address(family.name, *of_task.first, c.name));
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
        if (!options.scale)
            scales.insert({family.scale_min, family.scale_max});
        const bool has_k = !options.k || (!family.k_meaning.empty() && *options.k >= family.k_min &&
                                          *options.k <= family.k_max);
        for (const int scale : scales) {
            spec.scale = scale;
            const bool is_extreme = !options.scale && scale != middle;
            spec.n = is_extreme && options.is_quick ? n_of_quick_extremes(options.n) : options.n;
            if (has_k && scale >= family.scale_min && scale <= family.scale_max)
                scenes.push_back(spec);
        }
    }
    if (scenes.empty())
        throw BadInput(
            is_any_meant
                ? std::string("--k or --scale is out of range for the families that --only names "
                              "(`boxwood list families` tells the ranges)")
                : fmt::format("--only \"{}\" names no family/task/kernel; see `boxwood list "
                              "families` and `boxwood list kernels`{}",
                              options.only,
                              options.ccd.empty() ? " (families of files need --ccd DIR)" : ""));
    return scenes;
}

CheckRun::CheckRun(const CheckOptions& options, const results::Env& env, ContendersOf contenders)
    : options_(options), contenders_(std::move(contenders)), only_(options.only),
      budget_ns_(options.is_quick ? 2e5 : 1e6), record_(env, "boxwood check") {}

std::vector<ContenderEntry> CheckRun::chosen(const std::string& family, const Task& task) const {
    std::vector<ContenderEntry> all = contenders_(task);
    std::erase_if(
        all, [&](const ContenderEntry& c) { return !only_.is_in(address(family, task, c.name)); });
    return all;
}

void CheckRun::judge(const Scene& scene, const std::function<void(const Task&)>& starts) {
    std::vector<std::pair<const Task*, std::vector<ContenderEntry>>> work;
    std::string names;
    for (const Task* task : tasks())
        if (task->fits(scene.cases)) {
            work.emplace_back(task, chosen(scene.spec.generator, *task));
            names += fmt::format("{}{}", names.empty() ? "" : ",", task->name());
        }
    const std::uint32_t scene_id = record_.add_scene(scene, names);
    for (const auto& [task, contenders] : work) {
        if (contenders.empty())
            continue;
        starts(*task);
        judge_task(scene, scene_id, *task, contenders);
    }
}

void CheckRun::judge_task(const Scene& scene, std::uint32_t scene_id, const Task& task,
                          const std::vector<ContenderEntry>& contenders) {
    const std::unique_ptr<Truth> truth = task.make_truth(scene, all_cores());
    said_.clear();
    const std::string executor(default_executor(1));
    for (const ContenderEntry& contender : contenders) {
        const std::string name =
            format_cell_name({scene.name, scene.spec.n, scene.spec.seed, std::string(task.name()),
                              contender.name, contender.precision, executor, 1});
        const Job job{&scene, &task, executor, 1};
        const results::Cell cell = record_.cell(name, job, scene_id, contender);
        double query_ns = 0;
        Judgement judgement = judged(job, *truth, contender, query_ns);
        if (!judgement.kernel) // could not answer
            judgement.kernel.emplace();
        results::KernelRow& row = *judgement.kernel;
        row.family = scene.spec.generator;
        row.panel = to_string(panel_of(scene));
        row.task = task.name();
        row.kernel = contender.name;
        row.promise = to_string(contender.promise);
        row.witness = judgement.check.witness;
        record_.out.cells.push_back(cell);
        record_.add(std::move(judgement), cell.cell_id, query_ns);
    }
    const auto* cases = dynamic_cast<CaseTruth*>(truth.get());
    if (options_.one && cases)
        details_ += fmt::format("{}/{}, case {}\n{}\n{}", scene.name, task.name(), *options_.one,
                                cases->case_text(0), said_);
}

/// What one contender answered is worth; what it throws is recorded.
Judgement CheckRun::judged(const Job& job, Truth& truth, const ContenderEntry& contender,
                           double& query_ns) {
    Judgement judgement;
    const auto fail = [&](Status status, const std::string& why) {
        judgement = {};
        judgement.status = status;
        judgement.check.witness = why;
    };
    if (const auto why = contender.unsupported(job)) {
        fail(Status::unsupported, *why);
        return judgement;
    }
    try {
        const std::unique_ptr<Answers> answers = job.task->make_answers();
        const Outcome outcome = outcome_of(contender, job, budget_ns_, *answers);
        if (!outcome.failure.empty())
            throw std::runtime_error(outcome.failure);
        query_ns = outcome.ns;
        judgement = truth.judge(*answers, contender);
        judgement.check.result_hash = job.task->hash(*answers);
        if (auto* cases = dynamic_cast<CaseTruth*>(&truth); options_.one && cases)
            said_ +=
                fmt::format("  {} ({}): {}; truth {}: {}\n", contender.name, contender.precision,
                            cases->answer_text(*answers, 0),
                            cases->truth_text(0, contender.precision), to_string(judgement.status));
    } catch (const InvalidBox& error) { // the promised answer to a box that is none
        fail(is_bad_box(*job.scene, error.index) ? Status::unsupported : Status::wrong,
             error.what());
    } catch (const std::exception& error) {
        fail(Status::wrong, error.what());
    }
    return judgement;
}

} // namespace boxwood::bench
