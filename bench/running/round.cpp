#include "bench/running/round.h"

#include "bench/running/calibration.h"
#include "bench/running/prepare.h"
#include "bench/tasks/scene_queries.h"
#include "bench/truth/truth.h"
#include "bench/running/usage.h"

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <chrono>
#include <cstdlib>
#include <map>
#include <memory>
#include <stdexcept>

namespace boxwood::bench {
namespace {

/// One timing of a cell in this round.
struct Timing {
    const PlannedCell* cell;
    Calibration calibration;
    std::uint32_t cell_id;
    std::uint64_t checked_hash, answers; ///< hash and number of the answers that were checked
    bool is_twin;
};

class Round final : public benchmark::BenchmarkReporter {
  public:
    Round(const Report& report, std::size_t timings, unsigned round)
        : report_(report), timings_(timings), round_(round) {}

    std::vector<results::Sample> samples;
    std::vector<results::FrameRow> frames;
    std::vector<results::EffectRow> effects;

    /// One contender at a time is alive: from the start of its build to the end of its query.
    void build(benchmark::State& state, const Timing& timing) {
        make(timing);
        start_sample(timing, "build");
        contender_->build(); // warms caches and allocator
        time(state, [&] { contender_->build(); });
        if (timing.cell->task == Ask::tree)
            finish(); // nothing is asked of it
    }

    /// Kernels have nothing to build, and no sample of it.
    void query(benchmark::State& state, const Timing& timing) {
        if (is_kernel_ask(timing.cell->task)) {
            make(timing);
            contender_->build();
        }
        start_sample(timing, "query");
        answers_ = {};
        if (timing.cell->task == Ask::pairs || timing.cell->task == Ask::tree_pairs ||
            timing.cell->task == Ask::triangle_pairs || timing.cell->task == Ask::points ||
            timing.cell->task == Ask::regions || timing.cell->task == Ask::rays_all)
            answers_.pairs.reserve(timing.answers);
        contender_->query(answers_); // warms caches and the answers' pages
        time(state, [&] { contender_->query(answers_); });
        if (answer_hash(answers_, timing.cell->task) != timing.checked_hash)
            samples.back().flags |= results::wrong_answer;
        finish();
    }

    /// Of moving scenes: passes through all frames, one untimed with every answer looked at, the
    /// last of the others looked at afterwards. Their times are our own: google-benchmark would
    /// add up update and query. What does not depend on the round is counted in round 0.
    void play_frames(benchmark::State& state, const Timing& timing) {
        Frames& all = frames_of(timing.cell->scene);
        const bool counts = round_ == 0 && !timing.is_twin;
        answers_ = {};
        std::vector<FrameTime> times(all.size());
        std::vector<FrameCount> counted(counts ? all.size() : 0);
        FramesHash hash;
        PairsDigest last;
        bool is_steady = true;
        play(*contender_, all, answers_, times, [&](std::size_t index, const Frame&) {
            last = digest_of(answers_.pairs);
            hash.add(last.hash);
            if (counts) {
                counted[index] = count_frame(*contender_, answers_);
                is_steady = is_steady && digest_of(answers_.pairs) == last;
            }
        });
        time_passes(state, timing, times, [&] {
            play(*contender_, all, answers_, times, [](std::size_t, const Frame&) {});
        });
        auto row = frames.end() - std::ssize(counted);
        for (const FrameCount& count : counted) {
            row->box_tests = count.box_tests;
            (row++)->sah = count.sah;
        }
        if (hash.value() != timing.checked_hash || !is_steady ||
            (!times.empty() && digest_of(answers_.pairs) != last))
            flag_wrong();
        finish();
    }

    /// The same of all that a scene asks, and its ledger.
    void play_stages(benchmark::State& state, const Timing& timing) {
        auto& stages = dynamic_cast<StagesContender&>(*contender_);
        const std::size_t n_frames = timing.cell->scene.moving->frames;
        std::vector<FrameTime> times(n_frames);
        FramesHash hash;
        std::uint64_t last = 0;
        play_scene(stages, n_frames, times, [&](std::size_t, const FrameAnswers& answers) {
            last = answers_hash(answers);
            hash.add(last);
        });
        std::vector<results::EffectRow> ledger;
        time_passes(state, timing, times, [&] {
            play_scene(stages, n_frames, times, [](std::size_t, const FrameAnswers&) {});
            add_ledger(ledger, stages.ledger());
        });
        if (hash.value() != timing.checked_hash || answers_hash(stages.frame_answers()) != last)
            flag_wrong();
        for (results::EffectRow& row : ledger) {
            if (timing.is_twin)
                break;
            row.cell_id = timing.cell_id;
            row.round = round_;
            row.total_ns /= static_cast<double>(state.iterations());
            effects.push_back(std::move(row));
        }
        finish();
    }

    bool ReportContext(const Context&) override { return true; }

    /// Called once after each of the functions above.
    void ReportRuns(const std::vector<Run>& runs) override {
        if (runs.size() != 1 || runs.front().error_occurred)
            throw std::runtime_error("google-benchmark did not report one run per sample");
        if (std::exchange(own_times_, false))
            return;
        const Run& run = runs.front();
        results::Sample& sample = samples.back();
        sample.iterations = static_cast<std::uint64_t>(run.iterations);
        sample.wall_ns = run.real_accumulated_time * 1e9 / static_cast<double>(run.iterations);
        sample.cpu_ns = run.cpu_accumulated_time * 1e9 / static_cast<double>(run.iterations);
    }

  private:
    /// One pass per iteration, each after a build that is not timed here: the samples of update and
    /// query, and the rows of the frames.
    template <class Pass>
    void time_passes(benchmark::State& state, const Timing& timing, std::span<FrameTime> times,
                     Pass pass) {
        std::ranges::fill(times, FrameTime{});
        for (const char* phase : {"update", "query"})
            start_sample(timing, phase);
        const Usage before;
        for ([[maybe_unused]] auto iteration : state) {
            contender_->build();
            pass();
        }
        const Usage after;
        results::Sample &update = samples.end()[-2], &query = samples.back();
        const auto passes = static_cast<double>(state.iterations());
        update.wall_ns = update.cpu_ns = query.wall_ns = query.cpu_ns = 0;
        const double played = passes * static_cast<double>(times.size());
        for (std::size_t f = 0; f < times.size(); ++f) {
            const FrameTime& time = times[f];
            update.wall_ns += time.update_ns / played;
            update.cpu_ns += time.update_cpu_ns / played;
            query.wall_ns += time.query_ns / played;
            query.cpu_ns += time.query_cpu_ns / played;
            if (!timing.is_twin)
                frames.push_back({timing.cell_id, 0, round_, static_cast<std::uint32_t>(f),
                                  time.update_ns / passes, time.query_ns / passes, time.pairs,
                                  results::no_count, results::missing});
        }
        for (results::Sample* sample : {&update, &query}) {
            sample->iterations = static_cast<std::uint64_t>(played);
            add_usage(*sample, before, after);
        }
        own_times_ = true;
    }

    /// Of the samples of the frames.
    void flag_wrong() {
        for (results::Sample* sample : {&samples.end()[-2], &samples.back()})
            sample->flags |= results::wrong_answer;
    }

    void make(const Timing& timing) {
        report_(done_, timings_, timing.cell->name);
        const PlannedCell& cell = *timing.cell;
        std::fegetenv(&floating_point_mode_);
        const Scene& scene = scene_of(cell.scene);
        contender_ = cell.contender.make(Job{&scene, cell.task, cell.executor, cell.threads});
    }

    void finish() {
        contender_.reset();
        std::fesetenv(&floating_point_mode_);
        ++done_;
    }

    void start_sample(const Timing& timing, const char* phase) {
        results::Sample sample;
        sample.cell_id = timing.cell_id;
        sample.round = round_;
        sample.position = static_cast<std::uint32_t>(samples.size());
        sample.phase = phase;
        sample.flags = timing.is_twin ? std::uint32_t{results::aa_twin} : 0;
        samples.push_back(sample);
    }

    template <class Body> void time(benchmark::State& state, Body body) {
        const Usage before;
        for ([[maybe_unused]] auto iteration : state)
            body();
        add_usage(samples.back(), before, Usage{});
    }

    const Scene& scene_of(const SceneSpec& spec) {
        const auto [found, is_new] = scenes_.try_emplace(scene_key(spec));
        if (is_new)
            found->second = make_scene(spec);
        return found->second;
    }

    /// Those of several scenes are kept while they fit.
    Frames& frames_of(const SceneSpec& spec) {
        const std::string key = scene_key(spec);
        if (!frames_.contains(key)) {
            std::size_t bytes = 0;
            for (const auto& [other, held] : frames_)
                bytes += held.bytes();
            if (bytes + Frames::max_baked > most_frame_bytes)
                frames_.clear();
            frames_.emplace(key, Frames(spec.moving));
        }
        return frames_.at(key);
    }

    static constexpr std::size_t most_frame_bytes = std::size_t{2} << 30;

    const Report& report_;
    std::size_t timings_, done_ = 0;
    unsigned round_;
    std::map<std::string, Scene> scenes_;
    std::map<std::string, Frames> frames_;
    std::unique_ptr<Contender> contender_;
    Answers answers_;
    std::fenv_t floating_point_mode_{};
    bool own_times_ = false; ///< the samples have their times already
};

std::vector<Timing> timings_of(const Plan& plan, const results::Results& prepared, unsigned round) {
    const Calibrations calibrations = calibrations_of(prepared.texts.at("calibration"));
    std::map<std::string, std::uint32_t, std::less<>> id_of;
    for (const results::Cell& cell : prepared.cells)
        id_of.emplace(cell.name, cell.cell_id);
    std::map<std::uint32_t, const results::Check*> check_of;
    for (const results::Check& check : prepared.checks)
        check_of.emplace(check.cell_id, &check);

    std::vector<Timing> timings;
    const std::string aa = choose_aa(prepared, calibrations);
    for (const PlannedCell& cell : plan.cells) {
        const auto found = calibrations.find(cell.name);
        if (found == calibrations.end() || !cell.is_in(round))
            continue;
        const std::uint32_t id = id_of.at(cell.name);
        const results::Check& check = *check_of.at(id);
        timings.push_back({&cell, found->second, id, check.result_hash, check.n_got, false});
        if (cell.name == aa) {
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

} // namespace

results::Results run_round(const Plan& plan, const results::Results& prepared, unsigned round,
                           const Report& report) {
    using namespace std::chrono;
    results::Results out;
    out.run_uuid = prepared.run_uuid;
    out.created_utc = prepared.created_utc;
    out.sweep_hash = prepared.sweep_hash;
    out.generator = prepared.generator;
    out.env = prepared.env;
    out.scenes = prepared.scenes;
    out.variants = prepared.variants;
    out.cells = prepared.cells;

    results::Shard shard;
    shard.round = round;
    shard.env_id = prepared.env.at(0).env_id;
    shard.pid = static_cast<std::uint32_t>(getpid());
    shard.order_seed = order_seed_of(plan.seed, round);
    shard.t0_utc_ns = static_cast<std::uint64_t>(
        duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count());
    double load = 0;
    if (getloadavg(&load, 1) == 1)
        shard.load1 = load;
    const std::uint64_t steal_before = steal_ticks();

    const std::vector<Timing> timings = timings_of(plan, prepared, round);
    Round engine(report, timings.size(), round);
    initialize_benchmark();
    benchmark::ClearRegisteredBenchmarks();
    const auto add = [](const std::string& name, std::uint64_t iterations, auto body) {
        benchmark::RegisterBenchmark(name.c_str(), body)
            ->Iterations(static_cast<benchmark::IterationCount>(iterations))
            ->Repetitions(1)
            ->UseRealTime()
            ->MeasureProcessCPUTime();
    };
    std::size_t expected = 0;
    for (const std::size_t i : shuffled_order(timings.size(), shard.order_seed)) {
        const Timing& timing = timings[i];
        if (!is_kernel_ask(timing.cell->task)) {
            add(timing.cell->name + "/build", timing.calibration.build_iterations,
                [&](benchmark::State& state) { engine.build(state, timing); });
            ++expected;
        }
        if (timing.cell->task == Ask::tree)
            continue;
        if (is_moving_ask(timing.cell->task)) {
            add(timing.cell->name + "/frames", timing.calibration.query_iterations,
                [&](benchmark::State& state) {
                    if (timing.cell->task == Ask::scene_queries)
                        engine.play_stages(state, timing);
                    else
                        engine.play_frames(state, timing);
                });
            expected += 2;
            continue;
        }
        ++expected;
        add(timing.cell->name + "/query", timing.calibration.query_iterations,
            [&](benchmark::State& state) { engine.query(state, timing); });
    }
    if (!timings.empty())
        benchmark::RunSpecifiedBenchmarks(&engine);
    benchmark::ClearRegisteredBenchmarks(); // they refer to what ends here

    if (engine.samples.size() != expected)
        throw std::runtime_error("google-benchmark did not run every cell of the round");
    shard.steal_ticks = steal_ticks() - steal_before;
    out.shards.push_back(shard);
    out.samples = std::move(engine.samples);
    out.frames = std::move(engine.frames);
    out.effects = std::move(engine.effects);
    return out;
}

} // namespace boxwood::bench
