#pragma once

#include "bench/analysis/times.h"
#include "results/results.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What a gate says of one row: by the numbers of that row alone.
enum class Gate : std::uint8_t { passes, open, fails };

/// What two files say of one cell. cell_a is an id of the base, cell_b one of the head.
struct FileRow {
    std::string name;
    results::Comparison comparison;
    double base_ns = unknown, head_ns = unknown; ///< medians of the rounds that were paired
    /// The head takes at most so much of the base's time: the high end of the 95 % interval of this
    /// row alone.
    double max_ratio = unknown;
    bool is_newly_wrong = false;  ///< right in the base, wrong in the head
    bool is_same_samples = false; ///< times are equal, round by round
    Gate gate = Gate::open;
};
/// What the base has of a cell and the head has not, so that nothing can be said of it.
struct Lost {
    std::string cell, why;
    bool operator==(const Lost&) const = default;
};
struct FileComparison {
    std::vector<FileRow> rows;          ///< of ours
    std::vector<FileRow> peers;         ///< a gate for nothing: where they moved, the machine did
    std::vector<Lost> lost;             ///< of ours
    std::vector<std::string> only_head; ///< cells of ours
    std::size_t max_family = 0;         ///< rows that were decided together, at the most
    PairedRatio together;               ///< of all rows of ours: the geometric mean
    std::optional<double> floor;        ///< the highest of the twins in the two files
    double peers_ratio = unknown;       ///< the middle one of the peers' timings, head over base
    bool peers_moved = false; ///< by more than the limit: the times say nothing of the code
    bool is_same_cpu = false, is_same_machine = false;
    bool is_sealed = false; ///< both files are as they were written
    Gate gate = Gate::open; ///< of all
};
struct FileOptions {
    double delta = default_delta;                          ///< "same" is within this
    std::optional<double> fail_if{};                       ///< slower by more than this fails
    std::function<bool(const std::string& cell)> wanted{}; ///< else all; of the peers always all
    bool any_processor = false; ///< else times of two processor models are no evidence
    /// How much slower a timing may be.
    double limit() const { return fail_if.value_or(delta); }
};
/// Cells are matched by name, rounds by number: within a machine state that both files have, else
/// in order of time. Rows of one job (scene, task, threads) and phase are decided
/// together, so that one slip among many jobs is found. Needs Cell::status in both.
/// A row fails if it is newly wrong, or its verdict is slower and the interval that decided lies
/// above 1 + fail_if (1 without it); it passes if max_ratio is at most 1 + limit and the noise
/// floor is no higher (or the verdict is faster), or if all its times are equal. All fail if one
/// does; all pass if every row does, one is timed, nothing is lost and both files are sealed. Where
/// the peers moved, or on another processor unless any_processor, times neither fail nor pass.
FileComparison compare_files(const results::Results& base, const results::Results& head,
                             const FileOptions& options = {});

} // namespace boxwood::bench
