#pragma once

#include "bench/analysis/statistics.h"
#include "results/results.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The statistics of the bench, on the rows of a result file: medians over rounds, and paired
/// comparisons.
namespace boxwood::bench {

/// One phase of one cell over its rounds, the A/A twin left out. p95 and p99 as numpy's percentile.
struct CellStats {
    std::uint32_t cell_id = 0;
    std::string phase;
    std::size_t n = 0;
    double median_ns = results::missing, mad_ns = results::missing, min_ns = results::missing,
           p95_ns = results::missing, p99_ns = results::missing;
};
/// Ordered by cell, then phase.
std::vector<CellStats> cell_stats(const results::Results& results);

/// The times of every cell round by round, the A/A twin left out, with "build+query" and
/// "update+query" where a cell has both phases.
class RoundTimes {
  public:
    using RoundKey = std::pair<std::string, std::uint32_t>; ///< machine, round number
    using Rounds = std::map<RoundKey, std::vector<double>>; ///< wall_ns in order of time

    explicit RoundTimes(const results::Results& results);
    /// Null if the phase of the cell was not timed.
    const Rounds* rounds(std::uint32_t cell, const std::string& phase) const;
    /// Time of b over time of a, paired by round; no pairs if either was not timed.
    PairedRatio ratio(std::uint32_t a, std::uint32_t b, const std::string& phase) const;

  private:
    std::map<std::uint32_t, std::map<std::string, Rounds>> phases_; ///< by cell and phase
};

/// The A/A noise floor as a relative difference: the farthest end of the intervals of cells that
/// were timed twice. Nothing without such cells, or with fewer than 6 rounds.
std::optional<double> noise_floor(const results::Results& results);

enum class Standing { right, wrong, unchecked };
/// By cell_id: wrong if any check or any timed round says so, right if all checks are fine.
std::map<std::uint32_t, Standing> standings(const results::Results& results);

/// Each cell of ours (b) against each peer (a) on the same scene, ask and threads, for each phase
/// that both have and for "build+query" and "update+query". Rounds are paired by number within a
/// machine. The claims about one cell of ours in one phase are a family. Cells with a wrong answer
/// get the verdict "wrong" and no ratio; unchecked ones are never ranked either ("cannot_tell").
std::vector<results::Comparison> compare_to_peers(const results::Results& results,
                                                  double delta = default_delta);

/// One cell and phase in two files. cell_a is an id of the base, cell_b one of the head.
struct FileRow {
    std::string name;
    results::Comparison comparison;
    bool is_newly_wrong = false; ///< right in the base, wrong in the head
};
struct FileComparison {
    std::vector<FileRow> rows;
    std::vector<std::string> only_base, only_head; ///< cells that were timed in one file alone
    std::vector<std::string> other_content;        ///< cells whose scenes differ
    std::size_t family_size = 0;
    std::optional<double> floor; ///< the larger one of the two files
    bool is_same_machine = false;
};
/// Cells are matched by name, rounds by number: within a machine state that both files have, else
/// in order of time. All rows are one family.
FileComparison compare_files(const results::Results& base, const results::Results& head,
                             double delta = default_delta);

} // namespace boxwood::bench
