#pragma once

#include "bench/io/pattern.h"
#include "bench/io/progress.h"
#include "bench/running/record.h"
#include "bench/tasks/task.h"
#include "results/results.h"
#include "scenes/hard_cases/hard_cases.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boxwood::bench {

struct CheckOptions {
    std::string only;     ///< regular expression searched for in "family/task/kernel"
    std::size_t n = 1000; ///< wanted cases of a family
    std::uint64_t seed = 1;
    std::optional<int> k, scale;    ///< else each family's default, and three scales
    std::optional<std::size_t> one; ///< judge this case alone
    std::filesystem::path ccd;      ///< for the families that read a file or folder
    bool is_quick = false;          ///< few cases, fewer at the extreme scales
};

/// Who is judged: ours and the peers that answer a task on cases.
std::vector<ContenderEntry> contenders_of(const Task& task);

/// The scenes of a check: each family that `only` can mean, at its default k and three scales (the
/// extremes of its range, and 0 or what is next to it). Throws BadInput if --k or --scale suits
/// none of them, and for a bad --only.
std::vector<SceneSpec> check_scenes(const CheckOptions& options);

/// Judges contenders on the cases of scenes, each with a short timing of its own.
class CheckRun {
  public:
    using ContendersOf = std::function<std::vector<ContenderEntry>(const Task&)>;
    CheckRun(const CheckOptions& options, const results::Env& env,
             ContendersOf contenders = contenders_of);

    /// Every task that fits the scene's cases. What a contender throws is recorded. `starts` is
    /// called before each task.
    void judge(const Scene& scene, const std::function<void(const Task&)>& starts);

    /// With `one`: the case, its truth and what everybody answered.
    const std::string& details() const { return details_; }
    /// No shards and no samples.
    const results::Results& results() const { return record_.out; }

  private:
    void judge_task(const Scene& scene, std::uint32_t scene_id, const Task& task,
                    const std::vector<ContenderEntry>& contenders);
    Judgement judged(const Job& job, Truth& truth, const ContenderEntry& contender,
                     double& query_ns);
    std::vector<ContenderEntry> chosen(const std::string& family, const Task& task) const;

    const CheckOptions& options_;
    ContendersOf contenders_;
    Pattern only_;
    double budget_ns_; ///< of one timing
    std::string said_; ///< what everybody answered to the one case
    Record record_;
    std::string details_;
};

} // namespace boxwood::bench
