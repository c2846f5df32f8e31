#pragma once

#include "bench/tasks/contender.h"
#include "bench/stages/frame_answers.h"
#include "bench/stages/ledger.h"
#include "bench/stages/plan_stages.h"

#include <string_view>

namespace boxwood::bench {

/// A contender of scene_queries: build is ScenePlayer::start, update(frame) its advance, query its
/// ask. `query` fills no Answers: what was answered lies here, as found.
class StagesContender : public Contender {
  public:
    /// Of the last query; good until the next update or build.
    virtual const FrameAnswers& frame_answers() const = 0;
    /// Since the last build.
    virtual const Ledger& ledger() = 0;
};

/// "required", "all_stages", or "required.without_<effect>": the scene without one of its
/// effects, unsupported if it has none of that word. It plays the scene of
/// job.scene->spec.moving with the spec's n and seed. Throws std::invalid_argument, with a
/// suggestion, for an unknown effect. Its contenders are StagesContenders.
ContenderEntry stages_contender(Extent extent, std::string_view without_effect = {});

} // namespace boxwood::bench
