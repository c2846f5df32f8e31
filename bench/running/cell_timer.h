#pragma once

#include "bench/io/progress.h"
#include "bench/machine/caches.h"
#include "bench/plan/plan.h"
#include "bench/running/calibration.h"
#include "bench/running/play.h"
#include "bench/tasks/instruction_sets.h"
#include "results/results.h"

#include <benchmark/benchmark.h>

#include <cfenv>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boxwood::bench {

/// One timing of a cell in a round.
struct Timing {
    const PlannedCell* cell;
    SceneSpec scene; ///< of the round's input
    Calibration calibration;
    std::uint32_t cell_id;
    std::uint64_t checked_hash, answers; ///< hash and number of the answers that were checked
    bool is_twin;
};

/// Runs the timings of one round, phase by phase, inside google-benchmark's loops, and collects
/// their rows. One contender at a time is alive: from the start of its first phase to the end of
/// its last.
class CellTimer {
  public:
    CellTimer(const Report& report, std::size_t timings, unsigned round)
        : report_(report), timings_(timings), round_(round) {}

    /// First a build that is not timed, then as calibrated.
    void build(benchmark::State& state, const Timing& timing);
    /// After build, or alone for a task that has nothing to build.
    void query(benchmark::State& state, const Timing& timing);
    /// After build: passes through all frames, one untimed with every answer looked at, the last of
    /// the others looked at afterwards. Their times are our own: google-benchmark would add up
    /// update and query. What does not depend on the round is counted in round 0.
    void frames(benchmark::State& state, const Timing& timing);
    /// Takes google-benchmark's times of the last of these.
    void take(const benchmark::BenchmarkReporter::Run& run);

    std::vector<results::Sample> samples;
    /// By other clocks than google-benchmark's: parts of others on a device, and cold queries.
    std::vector<results::Sample> own_samples;
    std::vector<results::FrameRow> frame_rows;
    std::vector<results::EffectRow> effects;

  private:
    void make(const Timing& timing);
    void finish();
    void start_sample(const Timing& timing, results::Phase phase);
    void add_device_samples();
    /// Each of the task's queries alone, after the caches are flushed; the sum is a sample.
    void add_cold_query(const Timing& timing);
    void time_passes(benchmark::State& state, const Timing& timing, Frames* frames,
                     std::span<FrameTime> times);
    void add_frame_rows(const Timing& timing, std::span<const FrameTime> times, double passes);
    void add_ledger(const Timing& timing, std::vector<results::EffectRow> rows, double passes);
    const Scene& scene_of(const SceneSpec& spec);
    Frames& frames_of(const SceneSpec& spec);

    const Report& report_;
    std::size_t timings_, done_ = 0;
    unsigned round_;
    std::map<std::string, Scene> scenes_;
    std::map<std::string, Frames> frames_;
    std::optional<CacheFlush> flush_;
    std::optional<InstructionSetLimit> instruction_set_; ///< of the contender
    std::unique_ptr<Contender> contender_;
    std::unique_ptr<Answers> answers_;
    std::fenv_t floating_point_mode_{};
    bool has_own_times_ = false; ///< the samples have their times already
};

} // namespace boxwood::bench
