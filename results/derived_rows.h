#pragma once

#include "results/measured_rows.h"

#include <cstdint>
#include <string>

/// The rows that bench/analysis derives from the measured ones when a file is written. Readers take
/// them as they are.
namespace boxwood::results {

/// One phase of one cell over its rounds, the A/A twin left out. p95 and p99 as numpy's percentile.
struct Median {
    std::uint32_t cell_id = 0;
    Phase phase = Phase::none;
    std::uint64_t n = 0;
    double median_ns = missing, mad_ns = missing, min_ns = missing, p95_ns = missing,
           p99_ns = missing;
    double limit_ns = missing; ///< a lower bound for any algorithm on the machine; NaN if not known
    double times_limit = missing; ///< the median over that
};

/// Cell b against cell a: the time of b over that of a, paired by round.
struct Comparison {
    std::uint32_t cell_a = 0, cell_b = 0;
    Phase phase = Phase::none;
    std::string contender_class; ///< the one that both are of
    std::uint64_t n_pairs = 0;
    double ratio = missing;
    /// The interval that decided: at the level of the claim within its family; of the verdict
    /// "same" at 95 %. NaN if there are too few rounds for one.
    double ci_lo = missing, ci_hi = missing;
    double p_adj = missing;
    double floor = missing; ///< the noise floor, relative; NaN if not known
    double delta = missing; ///< "same" is within this, relative
    Family family = Family::none;
    Verdict verdict = Verdict::none;
    Reason reason = Reason::none;
    std::string words; ///< both: "can't tell (too few rounds)"
};

/// How the time of one variant grows with the number of items: time ~ n^exponent.
struct SizeScaling {
    std::uint32_t cell_id = 0; ///< of the largest size
    Phase phase = Phase::none;
    std::uint64_t n_sizes = 0;
    double exponent = missing, exponent_lo = missing, exponent_hi = missing;
    double off_line = missing; ///< how far the farthest median is from the fitted line, relative
};

/// After so many queries the longer build of b has paid for itself against a. Both are the best at
/// something: no other of their job builds and queries in less time. The one of a job that builds
/// in the least time has a row without an a.
struct BreakEven {
    std::uint32_t cell_a = no_id, cell_b = 0;
    double queries = missing;
};

/// One kernel on all families of one panel: time per call and errors.
struct KernelCost {
    std::string task, panel, kernel, library, promise;
    std::uint32_t is_peer = 0;
    double ns = missing; ///< mean over the families
    std::uint64_t n = 0, wrong = 0, maybe = 0;
    double max_rel_err = missing;
    double wrong_per_million = missing;
    double unexcluded_per_million = missing; ///< a rate that n right answers do not exclude (95 %)
    std::uint32_t by_error = 0; ///< 1 if its task is judged by errors, and not by yes or no
    /// By which kernels are ranked: wrong_per_million; by errors max_rel_err, 0 up to half an ulp
    /// of a double and infinite above 1, where no digit is right.
    double badness = missing;
    std::uint32_t on_front = 0; ///< 1 if ours, never undecided, and no faster such one errs less
};

/// What a topic of findings is called, and the columns of its rows.
struct TopicRow {
    Topic topic = Topic::none;
    std::string title, question, together, alone, certainty;
};

/// One question of a run and its answer, in words: the rows of the one screen and of the report.
struct Finding {
    std::uint32_t place = 0; ///< its place on the screen: losses first
    Topic topic = Topic::none;
    std::uint32_t is_headline = 0; ///< 1 if it stands for its question on one screen
    std::uint32_t is_loss = 0;     ///< 1 if the rival is better for sure
    std::uint32_t scene_id = no_id;
    std::string task;
    std::uint32_t threads = 1;
    std::string contender_class;
    std::string question;
    std::string together;  ///< build and query, against the best rival
    std::string alone;     ///< query alone, against the best rival
    std::string certainty; ///< the interval that decided, and of which measure
    /// Ours and the rival of both measures; no_id where there is none.
    std::uint32_t ours = no_id, rival = no_id, ours_alone = no_id, rival_alone = no_id;
};

/// Whether the run can be believed.
struct Health {
    std::uint64_t rounds = 0; ///< of the cell that was timed in the most of them
    std::uint64_t samples = 0;
    std::uint64_t disturbed = 0;    ///< samples that lost time to the hypervisor or a switch
    double floor = missing;         ///< the A/A noise floor, relative
    double delta = missing;         ///< with which the verdicts were made
    std::uint32_t is_too_noisy = 0; ///< even the lowest floor is above 50 %
    std::uint64_t answers = 0;      ///< cells whose answers were checked
    std::uint64_t wrong_ours = 0, wrong_peers = 0;
    std::uint64_t broken_promises = 0; ///< of kernels of ours
    /// In words, for every reader. trust: rounds, noise, whether quiet enough; empty if nothing was
    /// timed. advice: what to do about a run that is too noisy, else empty.
    std::string trust, correctness, advice;
};

/// One frame of one cell over its rounds.
struct FrameMedian {
    std::uint32_t cell_id = 0, frame = 0;
    double frame_ns = missing, query_ns = missing; ///< of update and query together; of the query
    double over_fresh = missing; ///< its query over that of a structure made for the frame
    double box_tests_per_item = missing, sah = missing; ///< counted
};

/// The frames of one cell, each by its median over the rounds.
struct FrameStats {
    std::uint32_t cell_id = 0;
    std::uint32_t fresh_cell = no_id; ///< what rebuilds for every frame; none: its own first frame
    std::uint64_t n = 0;
    double p50_ns = missing, p95_ns = missing, p99_ns = missing, max_ns = missing;
    double over_1_ms = missing, over_16_6_ms = missing; ///< share of the frames
    double degradation = missing; ///< over_fresh of the last frame over that of the first
};

/// One stage of the plan of a moving scene over the rounds, in a mean frame.
struct StageCost {
    std::uint32_t cell_id = 0;
    std::string stage, effect;
    std::uint32_t required = 0;
    std::uint64_t calls = 0, items = 0, bytes = 0; ///< as in effects
    double ns = 0, until_ns = 0; ///< of a frame: its own, and with all stages before it
    double share = 0;            ///< of the frame
};

/// What an effect of a moving scene costs, or all stages beyond the required ones.
struct EffectCost {
    std::uint32_t cell_with = 0, cell_without = 0;
    std::string what;                               ///< the effect, or "all stages"
    double with_ns = missing, without_ns = missing; ///< of a frame
    double ratio = missing, ci_lo = missing, ci_hi = missing;
    double extra_ns = missing; ///< what a frame takes more, by the ratio
};

/// One kernel at one condition number over all families.
struct KernelCondition {
    std::string task, kernel, library, promise;
    std::uint32_t is_peer = 0;
    double log10_condition = missing;
    std::uint64_t n = 0;
    double max_rel_err = missing, bound = missing;
};

/// Our best of one scene and task on a device, from the host's boxes to the host's answers, beside
/// our best on processors: medians of the total of the task, in the same rounds.
struct DeviceGain {
    std::uint32_t scene_id = 0;
    std::string task;
    std::uint64_t n = 0;
    double cpu_1_ns = missing, cpu_2_ns = missing, cpu_all_ns = missing;
    std::uint32_t threads = 0; ///< of cpu_all: the most that were timed
    double end_to_end_ns = missing;
    double resident_ns = missing; ///< boxes and answers stay on the device
    double graph_ns = missing;    ///< so, and each phase is one launch of a CUDA graph
    double device_ns = missing;   ///< of end to end what the device itself took
    double limit_ns = missing;    ///< of end to end
    double ratio = missing, ci_lo = missing, ci_hi = missing; ///< end to end over cell_cpu
    Verdict verdict = Verdict::none;                          ///< end to end against cell_cpu
    std::string words;
    std::uint32_t cell_1 = no_id, cell_2 = no_id, cell_all = no_id, cell_device = no_id,
                  cell_resident = no_id, cell_graph = no_id;
    std::uint32_t cell_cpu = no_id; ///< the fastest of cell_1, cell_2 and cell_all
};

/// From which of the measured sizes of a scene on the device wins end to end against the fastest of
/// one, two and all threads.
struct DeviceBreakEven {
    std::uint32_t scene_id = 0; ///< of the largest size
    std::string task;
    std::uint64_t n_sizes = 0;
    std::uint64_t wins_from = no_count; ///< it wins at this size and all larger ones
    std::uint64_t loses_to = no_count;  ///< the largest size at which it loses
    std::string words;
    std::uint32_t cell_cpu = no_id, cell_device = no_id; ///< of the largest size
};

/// Which share of its calls each tier of an adaptive kernel of ours decided.
struct Escalation {
    std::uint32_t cell_id = no_id; ///< no_id: of all families
    std::string task, kernel;
    double share_0 = 0, share_1 = 0, share_2 = 0, share_3 = 0;
};

/// A whole query with one kernel, where others stand under the same tree.
struct QueryKernel {
    std::uint32_t cell_id = 0;
    std::uint32_t group = 0;        ///< of queries that differ by the kernel alone
    std::string tree;               ///< "binned_sah.wide8.rays"
    double times_fastest = missing; ///< its time over that of the fastest of them
};

/// Counted work and time of one query, for each item, ray or point.
struct WorkRow {
    std::uint32_t cell_id = 0;
    double node_visits = missing, box_tests = missing, query_ns = missing;
};

/// The queries of one round against their cells' medians.
struct Drift {
    std::uint32_t shard_id = 0;
    std::uint64_t n = 0, disturbed = 0;
    double off_median = missing;   ///< the middle of those of its samples
    std::uint32_t is_farthest = 0; ///< 1 for the round that is off the most
};

} // namespace boxwood::results
