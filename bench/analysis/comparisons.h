#pragma once

#include "bench/analysis/times.h"
#include "bench/stages/variant_names.h"
#include "results/results.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// Every comparison within one file, cell b against cell a, for each phase that both have and for
/// the sums with the query. Claims of one line are decided together:
/// - peers: each cell of ours against the peers of its class in its job (scene, task, threads);
///   together are those about one cell of ours in one phase and class. Where one side alone has a
///   build of its own, its query holds all the work: only the sum is compared.
/// - ours: each cell of ours against the reference of its job (see reference_of); together are
///   those of one job and phase.
/// - threads: several threads against one, of each contender; together as for ours.
/// - stages: all stages against only the required ones, and a scene with an effect against the same
///   without it; together are those of one scene, number of threads and phase.
/// A wrong answer gets the verdict wrong and no ratio; what was not checked, cannot_tell.
/// Needs Cell::status, Cell::classes and Cell::builds.
std::vector<results::Comparison> comparisons_of(const results::Results& results, const Times& times,
                                                double delta);

/// The cell of ours that `judged` is held against: of the right ones of its job, executor,
/// precision and classes the builder hilbert with the same layout and kernel, else its first
/// hilbert, else its first. Null if that is itself, or it is a kernel on hard cases or a way to
/// play a scene.
const results::Cell* reference_of(const results::Results& results, const results::Cell& judged);

void set_ruling(results::Comparison& row, const Ruling& ruling);

/// What two files say of one cell. cell_a is an id of the base, cell_b one of the head.
struct FileRow {
    std::string name;
    results::Comparison comparison;
    bool is_newly_wrong = false; ///< right in the base, wrong in the head
    double hi_95 = unknown;      ///< high end of the 95 % interval of this row alone
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
/// in order of time. All rows are one family. Needs Cell::status in both.
FileComparison compare_files(const results::Results& base, const results::Results& head,
                             double delta = default_delta);

} // namespace boxwood::bench
