#pragma once

#include "bench/tasks/contender.h"
#include "bench/truth/judging/judge.h"
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

    /// Of a scene with its cells asked for `asks` (comma-separated words); gives its scene_id.
    std::uint32_t add_scene(const Scene& scene, std::string asks);
    /// The row of a cell that is about to be added. Adds the contender's variant if it is new.
    results::Cell cell(std::string name, const Scene& scene, std::uint32_t scene_id, Ask ask,
                       const ContenderEntry& contender, const std::string& executor,
                       unsigned threads);

    /// The kernel row and the condition rows of a cell; its check is the caller's.
    void add(Judgement judgement, std::uint32_t cell_id);

    results::Results out;

  private:
    std::uint32_t variant_id_of(const ContenderEntry& contender);
};

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
