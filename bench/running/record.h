#pragma once

#include "bench/tasks/task.h"
#include "bench/truth/truth.h"
#include "results/results.h"

#include <cfenv>
#include <cstdint>
#include <string>

namespace boxwood::bench {

/// The rows that a sweep's preparation and `boxwood check` have in common, as they come.
class Record {
  public:
    /// A run that starts now. generator: the command.
    Record(const results::Env& env, std::string generator);

    /// Of a scene on which these tasks are done (comma-separated); gives its scene_id.
    std::uint32_t add_scene(const Scene& scene, std::string tasks);
    /// The row of a cell that is about to be added. Adds the contender's variant if it is new.
    results::Cell cell(std::string name, const Job& job, std::uint32_t scene_id,
                       const ContenderEntry& contender);

    /// How a cell's row says these classes of a contender.
    static std::string classes_text(const Job& job, const std::vector<std::string>& classes);

    /// Check, kernel row and condition rows of a cell, whose query took so long.
    void add(Judgement judgement, std::uint32_t cell_id, double query_ns);

    results::Results out;

  private:
    std::uint32_t variant_id_of(const ContenderEntry& contender);
};

results::TaskRow task_row(const Task& task);

/// The number of its cases, or of its boxes.
std::uint64_t items_of(const Scene& scene);

/// Restores the rounding and denormal modes, which some libraries leave changed.
class KeepFloatingPointMode {
  public:
    KeepFloatingPointMode();
    ~KeepFloatingPointMode();
    KeepFloatingPointMode(const KeepFloatingPointMode&) = delete;

  private:
    std::fenv_t saved_;
};

} // namespace boxwood::bench
