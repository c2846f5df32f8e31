#include "bench/running/round.h"

#include "bench/machine/usage.h"
#include "bench/running/cell_timer.h"
#include "bench/running/child.h"
#include "bench/running/inputs.h"
#include "trees/device.h"

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

/// Receives google-benchmark's numbers, one run at a time, and hands them on.
class Reporter final : public benchmark::BenchmarkReporter {
  public:
    explicit Reporter(std::function<void(const Run&)> take) : take_(std::move(take)) {}

    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        if (runs.size() != 1 || runs.front().error_occurred)
            throw std::runtime_error("google-benchmark did not report one run per sample");
        take_(runs.front());
    }

  private:
    std::function<void(const Run&)> take_;
};

std::vector<Timing> timings_of(const Plan& plan, const results::Results& prepared, unsigned round) {
    const Calibrations calibrations = calibrations_of(prepared.texts.at("calibration"));
    std::map<std::string, std::uint32_t, std::less<>> id_of;
    for (const results::Cell& cell : prepared.cells)
        id_of.emplace(cell.name, cell.cell_id);
    std::map<std::uint32_t, const results::Check*> check_of;
    for (const results::Check& check : prepared.checks)
        check_of.emplace(check.cell_id, &check);

    const InputAnswers answers = input_answers_of(prepared.texts.at("inputs"));
    std::vector<Timing> timings;
    std::set<std::string> in_fewer_rounds, with_cold_caches;
    for (const PlannedCell& cell : plan.cells) {
        if (cell.rounds && *cell.rounds < plan.rounds)
            in_fewer_rounds.insert(cell.name);
        if (cell.cold_caches)
            with_cold_caches.insert(cell.name);
    }
    const std::set<std::string> twins =
        choose_twins(prepared, calibrations, in_fewer_rounds, with_cold_caches);
    for (const PlannedCell& cell : plan.cells) {
        const auto found = calibrations.find(cell.name);
        if (found == calibrations.end() || !cell.is_in(round))
            continue;
        const std::uint32_t id = id_of.at(cell.name);
        const results::Check& check = *check_of.at(id);
        const auto of_input = answers.find({cell.name, round % plan.inputs});
        const CheckedAnswers checked = of_input == answers.end()
                                           ? CheckedAnswers{check.result_hash, check.n_got}
                                           : of_input->second;
        timings.push_back({&cell, scene_in_round(plan, cell, round), found->second, id,
                           checked.hash, checked.n, false});
        if (twins.contains(cell.name)) {
            timings.push_back(timings.back());
            timings.back().is_twin = true;
        }
    }
    return timings;
}

/// google-benchmark takes its settings from a command line, and once per process.
void initialize_benchmark() {
    static const bool done = [] {
        std::array<char, 8> name{"boxwood"};
        std::array<char*, 2> argv{name.data(), nullptr};
        int argc = 1;
        benchmark::Initialize(&argc, argv.data());
        return true;
    }();
    (void)done;
}

/// Registers the phases of a timing; gives the number of samples that come of them.
std::size_t add_benchmarks(CellTimer& timer, const Timing& timing) {
    const auto add = [&](const char* phase, std::uint64_t iterations,
                         void (CellTimer::*run)(benchmark::State&, const Timing&)) {
        const std::string name = timing.cell->name + phase;
        benchmark::RegisterBenchmark(
            name.c_str(),
            [&timer, &timing, run](benchmark::State& state) { (timer.*run)(state, timing); })
            ->Iterations(static_cast<benchmark::IterationCount>(iterations))
            ->Repetitions(1)
            ->UseRealTime()
            ->MeasureProcessCPUTime();
    };
    const Phases phases = timing.cell->task->phases();
    std::size_t samples = 0;
    if (phases != Phases::query) {
        add("/build", timing.calibration.build_iterations, &CellTimer::build);
        ++samples;
    }
    if (phases == Phases::frames) {
        add("/frames", timing.calibration.query_iterations, &CellTimer::frames);
        samples += 2;
    } else if (phases != Phases::build) {
        add("/query", timing.calibration.query_iterations, &CellTimer::query);
        ++samples;
    }
    return samples;
}

void add_cold(std::vector<results::Sample>& samples, const Timing& timing, unsigned round,
              const Report& report, const std::function<ColdTimes(const std::string&)>& cold) {
    report(0, 1, timing.cell->name);
    const Usage before;
    const ColdTimes times = cold(timing.cell->name);
    for (const auto& [phase, ns] :
         {std::pair{results::Phase::cold_build, times.build_ns},
          std::pair{results::Phase::cold_build_and_query, times.build_and_query_ns}}) {
        results::Sample& sample = samples.emplace_back();
        sample.cell_id = timing.cell_id;
        sample.round = round;
        sample.position = static_cast<std::uint32_t>(samples.size() - 1);
        sample.phase = phase;
        sample.iterations = 1;
        add_usage(sample, before, Usage{});
        sample.wall_ns = ns;
        sample.nvcsw = sample.nivcsw = sample.minflt = 0; // they are another process's
        sample.flags &= results::disturbed_steal;
        if (timing.is_twin)
            sample.flags |= results::aa_twin;
        if (times.hash != timing.checked_hash)
            sample.flags |= results::wrong_answer;
    }
}

void add_rates(results::Shard& shard, const DeviceRates& rates) {
    shard.gpu_copy_gbs = rates.copy;
    shard.gpu_upload_gbs = rates.upload;
    shard.gpu_download_gbs = rates.download;
    shard.gpu_upload_pageable_gbs = rates.upload_pageable;
    shard.gpu_download_pageable_gbs = rates.download_pageable;
    shard.gpu_launch_ns = rates.launch_ns;
}

} // namespace

results::Results run_round(const Plan& plan, const results::Results& prepared, unsigned round,
                           const Report& report,
                           const std::function<ColdTimes(const std::string& cell)>& cold) {
    using namespace std::chrono;
    results::Results out;
    out.run_uuid = prepared.run_uuid;
    out.created_utc = prepared.created_utc;
    out.sweep_hash = prepared.sweep_hash;
    out.generator = prepared.generator;
    out.env = prepared.env;
    out.scenes = prepared.scenes;
    out.tasks = prepared.tasks;
    out.variants = prepared.variants;
    out.cells = prepared.cells;

    results::Shard shard;
    shard.round = round;
    shard.env_id = prepared.env.at(0).env_id;
    shard.pid = static_cast<std::uint32_t>(getpid());
    shard.order_seed = order_seed_of(plan.seed, round);
    shard.padding_bytes = own_padding();
    shard.input = round % plan.inputs;
    shard.t0_utc_ns = static_cast<std::uint64_t>(
        duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count());
    double load = 0;
    if (getloadavg(&load, 1) == 1)
        shard.load1 = load;
    const std::uint64_t steal_before = steal_ticks();

    const std::vector<Timing> timings = timings_of(plan, prepared, round);
    if (std::ranges::any_of(timings, [](const Timing& t) { return is_device(t.cell->executor); }))
        add_rates(shard, measure_rates(0));
    const std::vector<std::size_t> order = shuffled_order(timings.size(), shard.order_seed);
    if (cold)
        for (const std::size_t i : order)
            if (timings[i].cell->cold_build)
                add_cold(out.samples, timings[i], round, report, cold);
    CellTimer timer(report, timings.size(), round);
    Reporter reporter([&](const Reporter::Run& run) { timer.take(run); });
    initialize_benchmark();
    benchmark::ClearRegisteredBenchmarks();
    std::size_t expected = 0;
    for (const std::size_t i : order)
        expected += add_benchmarks(timer, timings[i]);
    if (!timings.empty())
        benchmark::RunSpecifiedBenchmarks(&reporter);
    benchmark::ClearRegisteredBenchmarks(); // they refer to what ends here

    if (timer.samples.size() != expected)
        throw std::runtime_error("google-benchmark did not run every cell of the round");
    shard.steal_ticks = steal_ticks() - steal_before;
    out.shards.push_back(shard);
    for (const std::vector<results::Sample>& samples : {timer.samples, timer.own_samples})
        out.samples.insert(out.samples.end(), samples.begin(), samples.end());
    out.frames = std::move(timer.frame_rows);
    out.effects = std::move(timer.effects);
    return out;
}

} // namespace boxwood::bench
