#pragma once

#include "results/words.h"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

/// The result file: relational tables, held whole in memory, written and read as one HDF5 file.
/// Schema version 2; results/README.md documents every table and column.
namespace boxwood::results {

inline constexpr double missing = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::uint32_t no_id = std::numeric_limits<std::uint32_t>::max();
inline constexpr std::uint64_t no_count = std::numeric_limits<std::uint64_t>::max();

/// One machine state.
struct Env {
    std::uint32_t env_id = 0;
    std::string env_hash, host, cpu;
    std::uint32_t ncpu = 0;
    std::uint64_t l1d_bytes = no_count, l2_bytes = no_count, l3_bytes = no_count;
    std::string isa_max, isa_used, governor, thp, virt, kernel;
    std::uint32_t mxcsr = 0;
    std::string compiler, flags, build_type, git_commit;
    std::uint32_t git_dirty = 0;
    double stream_triad_gbs_1 = missing, stream_triad_gbs_all = missing;
    double core_ghz = missing;
    std::uint64_t seed = 0;
};

/// A library that the program was built with, or a peer that was looked for.
struct Package {
    std::uint32_t env_id = 0;
    std::string library, version, revision;
    std::string build; ///< what is known of how it was compiled: SIMD, precision, threads
    std::uint32_t present = 1;
};

struct SceneRow {
    std::uint32_t scene_id = 0;
    std::string name, generator;
    std::string human_name; ///< for readers: "100,000 boxes, 1 % drift"; empty if it has none
    std::string rays;       ///< the kind of rays, which ends its name: "primary"
    std::uint64_t n_items = 0, n_triangles = 0, n_frames = 1, seed = 0;
    std::string effects, queries; ///< comma-separated words
    std::uint64_t content_hash = 0;
    std::string params_json;
};

/// One thing that was wanted of scenes.
struct TaskRow {
    std::string task;          ///< "rays_closest"
    std::string title;         ///< "nearest hit"
    Phase total = Phase::none; ///< what one use costs
    std::string total_title;   ///< "build and one query"
};

struct Variant {
    std::uint32_t variant_id = 0;
    std::string name, library, lib_version, builder, layout, traversal, kernel, predicates;
    std::string library_title; ///< for readers: "FCL"
    std::uint32_t is_peer = 0;
    std::uint32_t is_reference = 0; ///< its builder is the one that our others are held against
    std::uint32_t place = 0;    ///< of its builder, policy, way to play or library in its registry
    std::uint32_t is_plain = 1; ///< 0 if its builder or policy has settings, or an optimizer
    std::uint32_t answers_from_cache = 0; ///< 1 if its query tells nothing of its structure
    std::uint32_t keeps_structure = 1;    ///< 0 if its build only copies the input
    std::string stages; ///< of ways to play a scene: required, all, or the effect that is left out
    std::string params_json, notes;
};

struct Cell {
    std::uint32_t cell_id = 0;
    std::string name;
    std::uint32_t scene_id = 0, variant_id = 0;
    std::string task;
    std::string classes; ///< comma-separated; contenders of one job are compared within a class
    Status status = Status::unchecked; ///< derived: the worst of its checks and rounds
    std::uint64_t n_items = 0, n_queries = 0;
    std::string precision, executor;
    std::uint32_t threads = 1;
    std::string isa;
    std::uint64_t iterations = 0; ///< of the query phase, as calibrated
};

struct Shard {
    std::uint32_t shard_id = 0, round = 0, env_id = 0, pid = 0;
    std::uint64_t order_seed = 0, t0_utc_ns = 0;
    double load1 = missing;
    std::uint64_t steal_ticks = 0;
};

/// Bits of Sample::flags.
enum SampleFlag : std::uint32_t {
    disturbed_steal = 1,    ///< the hypervisor took time away during the sample
    disturbed_switches = 2, ///< involuntary context switches during the sample
    aa_twin = 4,            ///< the second timing of the A/A cell
    wrong_answer = 8        ///< this round's answer differs from the checked one
};

/// One timed phase of one cell in one round; times are per iteration.
struct Sample {
    std::uint32_t cell_id = 0, shard_id = 0, round = 0, position = 0;
    Phase phase = Phase::none;
    double wall_ns = missing, cpu_ns = missing;
    std::uint64_t iterations = 0, nvcsw = 0, nivcsw = 0, minflt = 0;
    std::uint32_t flags = 0;
    double off_median = missing; ///< derived: over the median of its cell and phase, less 1
};

/// One frame of a moving scene in one round of one cell: means over the passes of the round. What
/// is counted is the same in every round, and so round 0 alone counts it.
struct FrameRow {
    std::uint32_t cell_id = 0, shard_id = 0, round = 0, frame = 0;
    double update_ns = missing, query_ns = missing;
    std::uint64_t pairs = 0, box_tests = no_count;
    double sah = missing;
};

/// One stage of the plan of a moving scene in one round of one cell: sums over the frames of one
/// pass through the scene (means over the passes, where the round makes several). A stage that the
/// scene does not require has a row of zeros, so that what was left out can be seen.
struct EffectRow {
    std::uint32_t cell_id = 0, shard_id = 0, round = 0;
    std::string stage;  ///< advance_<effect> | move | fit | update | pairs | filter | ...
    std::string effect; ///< that it advances; empty for the others
    std::uint32_t required = 0;
    std::uint64_t calls = 0, items = 0;
    double total_ns = missing;
    std::uint64_t bytes = 0; ///< memory that the stage alone holds, at its most
};

struct Counter {
    std::uint32_t cell_id = 0;
    std::string counter; ///< node_visits box_tests triangle_tests pairs hits stack_max bytes ...
    std::uint64_t value = 0;
};

struct Check {
    std::uint32_t cell_id = 0;
    std::string oracle;
    Status status = Status::unchecked;
    std::uint64_t n_checked = 0, n_expected = 0, n_got = 0, missing = 0, extra = 0;
    double max_ulp = results::missing, max_abs_err = results::missing,
           max_rel_err = results::missing;
    std::uint64_t bound_violations = 0, result_hash = 0;
    std::string witness;
};

struct TreeRow {
    std::uint32_t cell_id = 0;
    std::uint64_t n_nodes = 0, n_leaves = 0, depth_max = 0;
    double depth_mean = missing, leaf_mean = missing;
    std::uint64_t bytes = 0;
    double sah_cost = missing, c_trav = missing, c_isect = missing, epo = missing,
           overlap = missing;
    std::uint32_t on_front = 0; ///< derived: no other of its job builds a cheaper tree in less time
};

/// One kernel, ours or a peer's, on one family of hard cases.
struct KernelRow {
    std::uint32_t cell_id = 0;
    std::string family; ///< hard-case family, or "typical"
    std::string panel;  ///< generic | touching | degenerate
    std::string task;   ///< triangle_triangle, ray_triangle, ...
    std::string kernel, promise;
    std::uint64_t n = 0;
    double ns_per_call = missing; ///< of the check's own timing; a sweep's samples are better
    std::uint64_t false_pos = 0, false_neg = 0, maybe = 0;
    double max_ulp = missing, max_rel_err = missing;
    std::uint64_t bound_violations = 0;
    double escalation_rate = missing; ///< share of the calls that tier 0 did not decide
    std::uint64_t tier_0 = 0, tier_1 = 0, tier_2 = 0, tier_3 = 0; ///< calls decided by each tier
    Status status = Status::unchecked;
    std::string witness;         ///< a wrong case and the command that replays it
    std::uint32_t is_broken = 0; ///< derived: a kernel of ours does not keep its promise
    std::string label;           ///< derived: tells a peer's kernel of floats from that of doubles
    double ns = missing;         ///< derived, per call: of the sweep, else of the check
    std::uint64_t wrong = 0;     ///< derived: false either way, or out of the bound
    double wrong_per_million = missing, maybe_per_million = missing; ///< derived
};

/// The error of one kernel at one condition number (a decade each).
struct ConditionRow {
    std::uint32_t cell_id = 0;
    double log10_condition = missing; ///< L/d of a distance, 1/sin^2 of a segment pair
    std::uint64_t n = 0;
    double max_rel_err = missing;
    double bound = missing; ///< the greatest relative bound that the kernel itself gave
};

// Derived from the rows above by bench/analysis when a file is written. Readers take them as they
// are.

/// One phase of one cell over its rounds, the A/A twin left out. p95 and p99 as numpy's percentile.
struct Median {
    std::uint32_t cell_id = 0;
    Phase phase = Phase::none;
    std::uint64_t n = 0;
    double median_ns = missing, mad_ns = missing, min_ns = missing, p95_ns = missing,
           p99_ns = missing;
    double limit_ns = missing;    ///< the least time that the machine could take; NaN if not known
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
    std::uint32_t on_front = 0; ///< 1 if ours and no faster one of ours errs less
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
    std::uint32_t is_too_noisy = 0; ///< the floor is above 20 %: measure again
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

/// Everything in one file. Ids are those of the `*_id` columns, unique within the file.
struct Results {
    std::string run_uuid, created_utc, sweep_hash, generator;
    bool complete = true;
    std::map<std::string, std::string> texts; ///< /text/*: argv, sweep_toml, lscpu, cmake_cache
    std::vector<Env> env;
    std::vector<Package> packages;
    std::vector<SceneRow> scenes;
    std::vector<TaskRow> tasks;
    std::vector<Variant> variants;
    std::vector<Cell> cells;
    std::vector<Shard> shards;
    std::vector<Sample> samples;
    std::vector<FrameRow> frames;
    std::vector<EffectRow> effects;
    std::vector<Counter> counters;
    std::vector<Check> checks;
    std::vector<TreeRow> trees;
    std::vector<KernelRow> kernels;
    std::vector<ConditionRow> conditions;
    std::vector<Median> medians;
    std::vector<Comparison> compare;
    std::vector<SizeScaling> size_scaling;
    std::vector<BreakEven> break_even;
    std::vector<KernelCost> kernel_costs;
    std::vector<TopicRow> topics;
    std::vector<Finding> findings;
    std::vector<Health> health; ///< one row
    std::vector<FrameMedian> frame_medians;
    std::vector<FrameStats> frame_stats;
    std::vector<StageCost> stage_costs;
    std::vector<EffectCost> effect_costs;
    std::vector<KernelCondition> kernel_conditions;
    std::vector<Escalation> escalations;
    std::vector<QueryKernel> query_kernels;
    std::vector<WorkRow> work;
    std::vector<Drift> drift;
    /// As read: false if another program changed the file since. Then none is written with a seal
    /// that holds its rows.
    bool is_sealed = true;
};

/// Writes to a temporary name beside `file`, marks it complete last, closes, syncs and renames: a
/// reader sees the old file or the whole new one. Throws std::runtime_error naming the file and the
/// cause (no such folder, no permission, disk full); the temporary file is removed.
void write(const std::filesystem::path& file, const Results& results);

/// What a file must hold: every table and column; or the tables that were measured alone, for who
/// derives the rest.
enum class Required : std::uint8_t { all, measured };

/// Throws std::runtime_error naming the file, the cause and what to do for one that is missing,
/// truncated, not HDF5, not ours, incomplete, or of another major version; that lacks what is
/// required; or that holds a word that is none, or an id of no row. Unknown tables and columns are
/// skipped.
Results read(const std::filesystem::path& file, Required required = Required::all);

/// Joins results of one or several machines: equal scenes, variants, cells and machine states (by
/// content key) become one row, and ids are remapped. Shards that stand in several parts are kept
/// once; what is derived is left out. Throws std::runtime_error, naming the parts by `names`, if
/// one cell name stands for different scene contents, or one shard has different samples in two
/// parts.
Results merge(std::span<const Results> parts, std::span<const std::string> names = {});

} // namespace boxwood::results
