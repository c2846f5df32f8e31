#pragma once

#include "bench/tasks/contender.h"
#include "scenes/effects/effect.h"
#include "scenes/moving/moving_scene.h"

namespace boxwood::bench {

/// Whether bodies of the scene come and go.
inline bool has_comers(const Job& job) {
    if (!job.scene->spec.moving || job.scene->spec.moving->recording)
        return false; // recorded bodies are always there
    for (const BodyGroup& group : job.scene->spec.moving->groups)
        for (const EffectChoice& effect : group.effects)
            if (effect_of(effect.name).changes.presence)
                return true;
    return false;
}

} // namespace boxwood::bench
