#pragma once

#include "results/derived_rows.h"
#include "results/measured_rows.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

/// The result file: relational tables, held whole in memory, written and read as one HDF5 file.
/// Schema version 2.1; results/README.md documents every table and column.
namespace boxwood::results {

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
    std::vector<DeviceGain> device_gains;
    std::vector<DeviceBreakEven> device_break_even;
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
/// one cell name stands for different scene contents, one shard has different samples in two parts,
/// or they were measured on two processor models, whose times are never pooled.
Results merge(std::span<const Results> parts, std::span<const std::string> names = {});

} // namespace boxwood::results
