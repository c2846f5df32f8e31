#pragma once

#include "results/words.h"

#include <cstdint>
#include <limits>
#include <string>

/// The rows of the tables that are measured.
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
    std::string gpu, gpu_driver; ///< empty where there is no device
    std::uint64_t gpu_sm = no_count, gpu_memory_bytes = no_count;
    double gpu_clock_ghz = missing;
    std::uint64_t gpu_l2_bytes = no_count;
    std::uint64_t memory_bytes = no_count;
    double quota = missing;                   ///< processors whose time a container may use
    std::uint32_t boost = no_id, smt = no_id; ///< 0 or 1
};

/// The processor's model and its widest instruction set: hosts may call two models by one name.
inline std::string processor(const Env& env) {
    return env.isa_max.empty() ? env.cpu : env.cpu + ", " + env.isa_max;
}

/// A library that the program was built with, or a peer that was looked for.
struct Package {
    std::uint32_t env_id = 0;
    std::string library, version, revision;
    std::string build; ///< what is known of how it was compiled: SIMD, precision, threads, flags
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
    std::string source, licence; ///< who made it, and SPDX; empty where nobody said
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
inline bool is_device(const Cell& cell) { return is_of_device(cell.executor); }

/// Of Shard::other_cores: above it the machine is not quiet.
inline constexpr double quiet_cores = .3;

struct Shard {
    std::uint32_t shard_id = 0, round = 0, env_id = 0, pid = 0;
    std::uint64_t order_seed = 0, t0_utc_ns = 0;
    double load1 = missing;
    std::uint64_t steal_ticks = 0;
    std::uint64_t padding_bytes = no_count;
    double other_cores = missing;
    std::uint32_t input = 0;       ///< of several: its scenes have their seed plus this
    double gpu_copy_gbs = missing; ///< this and the next before the round; NaN without a device
    double gpu_upload_gbs = missing, gpu_download_gbs = missing;
    double gpu_upload_pageable_gbs = missing, gpu_download_pageable_gbs = missing;
    double gpu_launch_ns = missing;
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
    std::uint64_t t_ns = no_count; ///< start of its timing, since 1970 UTC
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
    std::uint64_t bytes = 0; ///< memory that the stage alone holds, at its most; or what crossed
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

} // namespace boxwood::results
