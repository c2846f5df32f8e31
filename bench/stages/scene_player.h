#pragma once

#include "bench/stages/frame_answers.h"
#include "bench/stages/plan_stages.h"
#include "trees/device_memory.h"
#include "trees/executor.h"
#include "trees/world/bodies/ledger.h"

#include <memory>
#include <optional>
#include <vector>

namespace boxwood::bench {

class SceneStage;
struct Playing;

/// Plays a scene by its plan: a stage that does not run is not made. One virtual call per stage and
/// frame. The answers and their order are the same on every executor.
/// start, query, then advance and query for each further frame; a frame may go without a query.
class ScenePlayer {
  public:
    /// The scene stands at frame 0, the executor outlives this. place: of what runs on a device.
    /// Throws std::invalid_argument if it cannot be played there: why_not.
    ScenePlayer(MovingScene scene, Extent extent, const Executor& executor,
                Where where = Where::host, DevicePlace place = {});
    ~ScenePlayer();
    ScenePlayer(const ScenePlayer&) = delete;
    ScenePlayer& operator=(const ScenePlayer&) = delete;

    /// Makes what frame 0 needs; replaces what was there, and clears the ledger. The scene goes
    /// back to frame 0, for which it must be able to rewind if it has advanced.
    void start();
    /// To the next frame: effects, boxes and trees.
    void advance();
    /// The answers to all queries of the scene in the present frame; good until the next advance or
    /// start.
    const FrameAnswers& query();
    /// What the last query gave.
    const FrameAnswers& answers() const;

    const MovingScene& scene() const;
    const std::vector<PlannedStage>& plan() const { return plan_; }
    /// With the memory that each stage holds now.
    const Ledger& ledger();

  private:
    struct Made {
        std::size_t row; ///< of the ledger
        std::unique_ptr<SceneStage> stage;
    };
    enum class Runs { at_the_start, from_the_start, advancing, querying };

    void add(std::string_view name, std::unique_ptr<SceneStage> stage, Runs when);
    template <class Run> void timed(Made& made, std::size_t calls, const Run& run);

    std::unique_ptr<Playing> playing_;
    std::vector<PlannedStage> plan_;
    Ledger ledger_;
    std::vector<Made> stages_;
    std::vector<std::size_t> starting_, advancing_, noting_, querying_; ///< of stages_
};

} // namespace boxwood::bench
