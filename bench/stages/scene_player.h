#pragma once

#include "bench/stages/frame_answers.h"
#include "bench/stages/ledger.h"
#include "bench/stages/plan_stages.h"
#include "trees/executor.h"
#include "trees/work.h"

#include <memory>
#include <optional>
#include <vector>

namespace boxwood::bench {

class SceneStage;
struct Playing;

/// Plays a scene by its plan: a stage that does not run is not made. One virtual call per stage and
/// frame. The answers and their order are the same on every executor.
/// start, ask, then advance and ask for each further frame; an ask may be left out.
class ScenePlayer {
  public:
    /// The scene stands at frame 0, the executor outlives this.
    ScenePlayer(MovingScene scene, Extent extent, const Executor& executor);
    ~ScenePlayer();
    ScenePlayer(const ScenePlayer&) = delete;
    ScenePlayer& operator=(const ScenePlayer&) = delete;

    /// Makes what frame 0 needs; replaces what was there, and clears the ledger. The scene goes
    /// back to frame 0, for which it must be able to rewind if it has advanced.
    void start();
    /// To the next frame: effects, boxes and trees.
    void advance();
    /// What the scene asks of the present frame; good until the next advance or start.
    const FrameAnswers& ask();
    /// The work of the walk for pairs in the present frame; zero if no pairs are wanted.
    Work counted_pairs() const;

    const MovingScene& scene() const;
    const std::vector<PlannedStage>& plan() const { return plan_; }
    /// With the memory that each stage holds now.
    const Ledger& ledger();

  private:
    struct Step {
        std::size_t row; ///< of the ledger
        std::unique_ptr<SceneStage> stage;
    };
    void add_step(std::vector<Step>& to, std::string_view name, std::unique_ptr<SceneStage> stage);
    void run(std::vector<Step>& steps);

    std::unique_ptr<Playing> playing_;
    std::vector<PlannedStage> plan_;
    Ledger ledger_;
    std::vector<Step> starting_, advancing_, asking_;
};

} // namespace boxwood::bench
