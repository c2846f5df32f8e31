#pragma once

#include "bench/analysis/compare.h"
#include "results/results.h"

#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>

namespace boxwood::bench {

/// Update and query of a frame together, as a phase of RoundTimes.
inline const std::string frame_phase = "update+query";

/// The rows of a result file that its cells refer to, and their times. Refers to the results.
class RunIndex {
  public:
    explicit RunIndex(const results::Results& results);

    const results::Results& results() const { return results_; }
    const RoundTimes& times() const { return times_; }
    const results::SceneRow& scene(const results::Cell& cell) const {
        return *scenes_.at(cell.scene_id);
    }
    const results::Variant& variant(const results::Cell& cell) const {
        return *variants_.at(cell.variant_id);
    }
    bool is_right(const results::Cell& cell) const {
        return standing_of_.at(cell.cell_id) == Standing::right;
    }
    bool is_wrong(const results::Cell& cell) const {
        return standing_of_.at(cell.cell_id) == Standing::wrong;
    }
    /// Infinite if the phase was not timed; of several phases their sum.
    double median_ns(const results::Cell& cell, const std::string& phase) const;
    double median_ns(const results::Cell& cell, std::initializer_list<const char*> phases) const;
    /// Update and query of a frame of a moving scene.
    double frame_ns(const results::Cell& cell) const {
        return median_ns(cell, {"update", "query"});
    }

  private:
    const results::Results& results_;
    RoundTimes times_;
    std::map<std::uint32_t, Standing> standing_of_;
    std::map<std::uint32_t, const results::SceneRow*> scenes_;
    std::map<std::uint32_t, const results::Variant*> variants_;
    std::map<std::pair<std::uint32_t, std::string>, double> median_of_;
};

/// "3.12 [3.01, 3.20]": a ratio with its interval, where it has one; "-" for no pairs.
std::string interval_text(double ratio, double lo, double hi);

/// A verdict of results::Comparison in words: "can't tell".
std::string verdict_text(const std::string& verdict);

} // namespace boxwood::bench
