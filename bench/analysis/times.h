#pragma once

#include "bench/analysis/statistics.h"
#include "results/results.h"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// The samples of a result file by cell, phase and round.
namespace boxwood::bench {

/// The times of every cell round by round, the A/A twin left out, with the sums of build or update
/// and query where a cell has both phases.
class Times {
  public:
    /// Machine state and round number; in a merged file a machine may have a number several times.
    using RoundKey = std::pair<std::string, std::uint32_t>;
    using Rounds = std::map<RoundKey, std::vector<double>>; ///< wall_ns in order of time
    using Phases = std::map<results::Phase, Rounds>;

    explicit Times(const results::Results& results);
    /// Machine states outside `machines` are taken as one.
    Times(const results::Results& results, const std::set<std::string>& machines);

    const std::map<std::uint32_t, Phases>& by_cell() const { return cells_; }
    /// Null if the phase of the cell was not timed.
    const Rounds* rounds(std::uint32_t cell, results::Phase phase) const;
    /// Log of the time of b over that of a for every round that both have.
    std::vector<double> log_ratios(std::uint32_t a, std::uint32_t b, results::Phase phase) const;
    /// The inputs of the same rounds.
    std::vector<std::uint32_t> inputs(std::uint32_t a, std::uint32_t b, results::Phase phase) const;

  private:
    std::map<std::uint32_t, Phases> cells_;
    std::map<RoundKey, std::uint32_t> input_of_;
};

std::vector<double> log_ratios(const Times::Rounds& a, const Times::Rounds& b);
/// The median of what was timed in each round.
std::vector<double> medians_by_round(const Times::Rounds& rounds);
/// The median times of a and of b in the rounds that both have; NaN if there is none.
std::pair<double, double> paired_medians(const Times::Rounds& a, const Times::Rounds& b);

std::set<std::string> machines_of(const results::Results& results);

/// The A/A noise floors, as relative differences, by what is alike in noise: one thread or several,
/// below a millisecond or not, cold or not, and whether a structure is built or changed in it,
/// which takes and touches memory, or only read. Each is the farthest of the medians of the
/// phases that were timed twice, and of the interval that is in the middle of theirs (of two the
/// farther).
class NoiseFloors {
  public:
    /// Nothing from twins with fewer than 6 rounds.
    NoiseFloors(const results::Results& results, const Times& times);

    /// Of what is like this phase of this cell, and for a sum of its parts, too, the highest; the
    /// highest of all where no twin is. Nothing without twins.
    std::optional<double> of(const results::Cell& cell, results::Phase phase) const;
    /// For a comparison of two.
    std::optional<double> of(const results::Cell& a, const results::Cell& b,
                             results::Phase phase) const {
        return std::max(of(a, phase), of(b, phase)); // an absent one is less than any
    }
    /// Of phases that are cold or not.
    std::optional<double> highest(bool cold = false) const;
    std::optional<double> lowest() const; ///< of those that are not

  private:
    struct Likeness {
        bool has_threads, is_short, is_cold, is_read_only;
        auto operator<=>(const Likeness&) const = default;
    };
    Likeness likeness(const results::Cell& cell, results::Phase phase) const;

    const Times& times_;
    std::map<Likeness, double> floors_;
};

/// Ordered by cell, then phase; the limits from limits.h.
std::vector<results::Median> medians_of(const results::Results& results, const Times& times);

/// Medians by cell and phase, as a file has them.
class MedianIndex {
  public:
    explicit MedianIndex(const results::Results& results) {
        for (const results::Median& row : results.medians)
            ns_[{row.cell_id, row.phase}] = row.median_ns;
    }
    /// NaN if the phase of the cell was not timed.
    double ns(std::uint32_t cell, results::Phase phase) const {
        const auto found = ns_.find({cell, phase});
        return found == ns_.end() ? unknown : found->second;
    }

  private:
    std::map<std::pair<std::uint32_t, results::Phase>, double> ns_;
};

} // namespace boxwood::bench
