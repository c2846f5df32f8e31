#pragma once

#include "bench/tasks/moving_pairs.h"
#include "bench/stages/stages_contender.h"
#include "results/results.h"
#include "scenes/moving/frames.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What a sweep file names for Ask::scene_queries. stages: required, everything. without: effects,
/// or "each" for every effect that the scene has.
std::vector<ContenderEntry> scene_contenders(std::span<const std::string> stages,
                                             std::span<const std::string> without_effects,
                                             const SceneFile& scene);

/// Takes a contender that was just built through all frames of its scene, as `play` does.
void play_scene(StagesContender& contender, std::size_t n_frames, std::span<FrameTime> times,
                FunctionRef<void(std::size_t index, const FrameAnswers& answers)> after_frame);

/// Holds the contenders of one scene together: the pairs of each frame against the oracle of
/// MovingTruth, less those that the scene leaves out, and all answers against those of the first
/// contender that played the same scene.
class SceneTruth {
  public:
    SceneTruth(std::shared_ptr<const SceneFile> file, unsigned threads)
        : file_(std::move(file)), threads_(threads) {}

    /// One pass of a contender that was just built. contender_name: what it leaves out is left out
    /// here. Gives the hash of all answers.
    std::uint64_t check(StagesContender& contender, const std::string& contender_name,
                        std::span<FrameTime> times, results::Check& check);

  private:
    /// Of the scene as it is, or without one of its effects.
    struct Played {
        std::unique_ptr<Frames> frames;
        std::unique_ptr<MovingTruth> pairs;      ///< if they are asked
        std::vector<std::uint64_t> first_hashes; ///< by frame
    };
    Played& played_by(const std::string& contender_name);

    std::shared_ptr<const SceneFile> file_;
    unsigned threads_;
    std::map<std::string, Played> played_; ///< by the effect that is left out
};

/// Adds the ledger of one pass to the rows, which are as many, or none at first.
void add_ledger(std::vector<results::EffectRow>& rows, const Ledger& ledger);

} // namespace boxwood::bench
