#include "bench/running/cell_timer.h"

#include "bench/machine/usage.h"
#include "bench/running/prepare.h"
#include "bench/stages/plan_stages.h"
#include "trees/world/bodies/ledger.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace boxwood::bench {
namespace {

using results::Phase;

constexpr std::size_t max_frame_bytes = std::size_t{2} << 30;

/// Adds the ledger of one pass to the rows, which are as many, or none at first.
void accumulate(std::vector<results::EffectRow>& rows, const Ledger& ledger) {
    if (rows.empty())
        for (const LedgerRow& stage : ledger.rows()) {
            results::EffectRow& row = rows.emplace_back();
            row.stage = stage.stage;
            row.effect = advanced_effect(stage.stage);
            row.required = stage.is_required;
            row.calls = stage.calls;
            row.items = stage.items;
            row.total_ns = 0;
        }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].total_ns += ledger.rows()[i].ns;
        rows[i].bytes = std::max(rows[i].bytes, ledger.rows()[i].bytes);
    }
}

template <class Body> void time(benchmark::State& state, results::Sample& sample, Body body) {
    const Usage before;
    for ([[maybe_unused]] auto iteration : state)
        body();
    add_usage(sample, before, Usage{});
}

/// Caches, allocator and pages by one run; a device's clock, too, which idles low, and what it
/// makes in its second build alone.
template <class Work> void warm(const Timing& timing, const Work& work) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds clock_rises{50};
    const Clock::time_point begin = Clock::now();
    work();
    if (is_device(timing.cell->executor))
        do
            work();
        while (Clock::now() - begin < clock_rises);
}

} // namespace

void CellTimer::build(benchmark::State& state, const Timing& timing) {
    make(timing);
    start_sample(timing, Phase::build);
    warm(timing, [&] { contender_->build(); });
    time(state, samples.back(), [&] { contender_->build(); });
    if (timing.cell->task->phases() == Phases::build)
        finish();
}

void CellTimer::query(benchmark::State& state, const Timing& timing) {
    const Task& task = *timing.cell->task;
    if (task.phases() == Phases::query) {
        make(timing);
        contender_->build();
    }
    start_sample(timing, Phase::query);
    answers_ = task.make_answers();
    answers_->reserve(timing.answers);
    warm(timing, [&] { contender_->query(*answers_); });
    time(state, samples.back(), [&] { contender_->query(*answers_); });
    contender_->fetch(*answers_);
    if (task.hash(*answers_) != timing.checked_hash)
        samples.back().flags |= results::wrong_answer;
    add_device_samples();
    if (timing.cell->cold_caches)
        add_cold_query(timing);
    finish();
}

void CellTimer::add_device_samples() {
    for (const DeviceTime& part : contender_->device_times(*answers_)) {
        results::Sample& sample = own_samples.emplace_back(samples.back());
        sample.phase = part.phase;
        sample.iterations = 1;
        sample.wall_ns = part.ns;
    }
}

void CellTimer::add_cold_query(const Timing& timing) {
    using Clock = std::chrono::steady_clock;
    const Task& task = *timing.cell->task;
    const std::uint64_t n = task.n_queries(scene_of(timing.scene));
    if (!flush_)
        flush_.emplace(read_machine(""));
    answers_ = task.make_answers();
    answers_->reserve(timing.answers);
    Clock::duration time{};
    for (std::uint64_t part = 0; part < n; ++part) {
        (*flush_)();
        const Clock::time_point begin = Clock::now();
        contender_->query_part(*answers_, part);
        time += Clock::now() - begin;
    }
    results::Sample& sample = own_samples.emplace_back(samples.back());
    sample.phase = Phase::cold_query;
    sample.iterations = 1;
    sample.wall_ns = std::chrono::duration<double, std::nano>(time).count();
    sample.cpu_ns = results::missing;
    if (task.hash(*answers_) != timing.checked_hash)
        sample.flags |= results::wrong_answer;
}

void CellTimer::frames(benchmark::State& state, const Timing& timing) {
    const Task& task = *timing.cell->task;
    Frames* const given = task.plays_own_frames() ? nullptr : &frames_of(timing.cell->scene);
    const bool counts = round_ == 0 && !timing.is_twin;
    answers_ = task.make_answers();
    std::vector<FrameTime> times(timing.cell->scene.moving->frames);
    std::vector<FrameCount> counted(counts ? times.size() : 0);
    FramesHash hash;
    std::uint64_t last = 0;
    bool is_steady = true;
    play(*contender_, given, *answers_, times, [&](std::size_t index, const Frame&) {
        last = task.hash(*answers_);
        hash.add(last);
        if (counts) {
            counted[index] = count_frame(*contender_, *answers_);
            is_steady = is_steady && task.hash(*answers_) == last;
        }
    });
    time_passes(state, timing, given, times);
    auto row = frame_rows.end() - std::ssize(counted);
    for (const FrameCount& count : counted) {
        row->box_tests = count.box_tests;
        (row++)->sah = count.sah;
    }
    if (hash.value() != timing.checked_hash || !is_steady ||
        (!times.empty() && task.hash(*answers_) != last))
        for (results::Sample* sample : {&samples.end()[-2], &samples.back()})
            sample->flags |= results::wrong_answer;
    finish();
}

/// One pass per iteration, each after a build that is not timed here: the samples of update and
/// query, the rows of the frames, and the ledger.
void CellTimer::time_passes(benchmark::State& state, const Timing& timing, Frames* frames,
                            std::span<FrameTime> times) {
    std::ranges::fill(times, FrameTime{});
    std::vector<results::EffectRow> ledger;
    for (const Phase phase : {Phase::update, Phase::query})
        start_sample(timing, phase);
    const Usage before;
    for ([[maybe_unused]] auto iteration : state) {
        contender_->build();
        play(*contender_, frames, *answers_, times, [](std::size_t, const Frame&) {});
        if (const Ledger* of_pass = contender_->ledger())
            accumulate(ledger, *of_pass);
    }
    const Usage after;
    results::Sample &update = samples.end()[-2], &query = samples.back();
    const auto passes = static_cast<double>(state.iterations());
    const double played = passes * static_cast<double>(times.size());
    update.wall_ns = update.cpu_ns = query.wall_ns = query.cpu_ns = 0;
    for (const FrameTime& time : times) {
        update.wall_ns += time.update_ns / played;
        update.cpu_ns += time.update_cpu_ns / played;
        query.wall_ns += time.query_ns / played;
        query.cpu_ns += time.query_cpu_ns / played;
    }
    for (results::Sample* sample : {&update, &query}) {
        sample->iterations = static_cast<std::uint64_t>(played);
        add_usage(*sample, before, after);
    }
    has_own_times_ = true;
    if (timing.is_twin)
        return;
    add_frame_rows(timing, times, passes);
    add_ledger(timing, std::move(ledger), passes);
}

void CellTimer::add_frame_rows(const Timing& timing, std::span<const FrameTime> times,
                               double passes) {
    for (std::size_t f = 0; f < times.size(); ++f)
        frame_rows.push_back({timing.cell_id, 0, round_, static_cast<std::uint32_t>(f),
                              times[f].update_ns / passes, times[f].query_ns / passes,
                              times[f].answers, results::no_count, results::missing});
}

void CellTimer::add_ledger(const Timing& timing, std::vector<results::EffectRow> rows,
                           double passes) {
    for (results::EffectRow& row : rows) {
        row.cell_id = timing.cell_id;
        row.round = round_;
        row.total_ns /= passes;
        effects.push_back(std::move(row));
    }
}

void CellTimer::take(const benchmark::BenchmarkReporter::Run& run) {
    if (std::exchange(has_own_times_, false))
        return;
    results::Sample& sample = samples.back();
    sample.iterations = static_cast<std::uint64_t>(run.iterations);
    sample.wall_ns = run.real_accumulated_time * 1e9 / static_cast<double>(run.iterations);
    sample.cpu_ns = run.cpu_accumulated_time * 1e9 / static_cast<double>(run.iterations);
}

void CellTimer::make(const Timing& timing) {
    report_(done_, timings_, timing.cell->name);
    const PlannedCell& cell = *timing.cell;
    std::fegetenv(&floating_point_mode_);
    const Scene& scene = scene_of(timing.scene);
    instruction_set_.emplace(cell.isa);
    contender_ = cell.contender.make(Job{&scene, cell.task, cell.executor, cell.threads, cell.isa});
}

void CellTimer::finish() {
    contender_.reset();
    instruction_set_.reset();
    std::fesetenv(&floating_point_mode_);
    ++done_;
}

void CellTimer::start_sample(const Timing& timing, Phase phase) {
    results::Sample sample;
    sample.cell_id = timing.cell_id;
    sample.round = round_;
    sample.position = static_cast<std::uint32_t>(samples.size());
    sample.phase = phase;
    sample.flags = timing.is_twin ? std::uint32_t{results::aa_twin} : 0;
    samples.push_back(sample);
}

const Scene& CellTimer::scene_of(const SceneSpec& spec) {
    const auto [found, is_new] = scenes_.try_emplace(scene_key(spec));
    if (is_new)
        found->second = make_scene(spec);
    return found->second;
}

/// Those of several scenes are kept while they fit.
Frames& CellTimer::frames_of(const SceneSpec& spec) {
    const std::string key = scene_key(spec);
    if (!frames_.contains(key)) {
        std::size_t bytes = 0;
        for (const auto& [other, held] : frames_)
            bytes += held.bytes();
        if (bytes + Frames::max_baked > max_frame_bytes)
            frames_.clear();
        frames_.emplace(key, Frames(spec.moving));
    }
    return frames_.at(key);
}

} // namespace boxwood::bench
