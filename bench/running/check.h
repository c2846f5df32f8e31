#pragma once

#include "bench/tasks/contender.h"
#include "bench/io/progress.h"
#include "bench/running/record.h"
#include "results/results.h"
#include "scenes/hard_cases/hard_cases.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <regex>
#include <span>
#include <string>
#include <vector>

namespace boxwood::bench {

struct CheckOptions {
    std::string only;     ///< regular expression searched for in "family/task/rung"
    std::size_t n = 1000; ///< wanted cases of a family
    std::uint64_t seed = 1;
    std::optional<int> k, scale;    ///< else each family's default, and three scales
    std::optional<std::size_t> one; ///< judge this case alone
    std::filesystem::path ccd;      ///< for the families that read a file or folder
    bool is_quick = false;          ///< few cases, one scale
};

/// Who is asked: the rungs and peers that answer an ask; trees and peers for `pairs`.
std::vector<ContenderEntry> contenders_of(Ask ask);

/// The scenes of a check: each family that `only` can mean, at its default k and three scales (the
/// extremes of its range, and 0 or what is next to it). Throws BadInput if --k or --scale suits
/// none of them, and for a bad --only.
std::vector<SceneSpec> check_scenes(const CheckOptions& options);

/// Judges contenders on the cases of scenes, each with a short timing of its own.
class CheckRun {
  public:
    using ContendersOf = std::function<std::vector<ContenderEntry>(Ask)>;
    CheckRun(const CheckOptions& options, const results::Env& env,
             ContendersOf contenders = contenders_of);

    /// Asks all that fits the scene's cases; box families for pairs. What a contender throws is
    /// recorded. `said` is called before each ask.
    void judge(const Scene& scene, const std::function<void(Ask)>& said);

    /// With `one`: the case, its truth and what everybody answered.
    const std::string& details() const { return details_; }
    /// No shards and no samples.
    const results::Results& results() const { return record_.out; }

  private:
    void judge_cases(const Scene& scene, std::uint32_t scene_id, Ask ask,
                     const std::vector<ContenderEntry>& chosen);
    void judge_pairs(const Scene& scene, std::uint32_t scene_id,
                     const std::vector<ContenderEntry>& chosen);
    std::vector<ContenderEntry> chosen(const std::string& family, Ask ask) const;
    template <class Work>
    void record_cell(const Scene& scene, std::uint32_t scene_id, Ask ask,
                     const ContenderEntry& contender, const Work& work);

    const CheckOptions& options_;
    ContendersOf contenders_;
    std::regex only_;
    double budget_ns_; ///< of one timing
    Record record_;
    std::string details_;
};

} // namespace boxwood::bench
