#pragma once

#include "bench/stages/frame_answers.h"
#include "bench/stages/plan_stages.h"
#include "bench/tasks/contender.h"

#include <string_view>

namespace boxwood::bench {

/// Of the task scene_queries: what the stages found, good until the next update or build.
struct StageAnswers final : Answers {
    const FrameAnswers* frame = nullptr;

    std::size_t size() const override { return frame ? frame->pairs.size() : 0; } ///< pairs
    void reserve(std::size_t) override {}
};

/// Names of two contenders; "required.without_<effect>" are the others.
inline constexpr std::string_view required_variant = "required", all_stages_variant = "all_stages";

/// A contender of scene_queries: build is ScenePlayer::start, update its advance, query its query.
/// Without an effect, it is unsupported if the scene has none of that name. It plays the scene of
/// job.scene->spec.moving with the spec's n and seed. Throws std::invalid_argument, with a
/// suggestion, for an unknown effect.
ContenderEntry stages_contender(Extent extent, std::string_view left_out = {});

} // namespace boxwood::bench
