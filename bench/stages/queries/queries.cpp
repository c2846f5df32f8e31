/// The stages of what a scene may ask. To add an ask: its row in scenes/moving/query.cpp, the file
/// WORD.cpp here, which defines `std::unique_ptr<SceneStage> WORD_ask()`, its word here, and its
/// line in plan_stages.cpp.

#include "bench/stages/playing.h"

#include <stdexcept>
#include <string>

#define BOXWOOD_SCENE_ASKS(X) X(pairs) X(triangle_pairs) X(rays) X(points) X(regions) X(nearest)

namespace boxwood::bench {

#define X(word) std::unique_ptr<SceneStage> word##_ask();
BOXWOOD_SCENE_ASKS(X)
#undef X

std::unique_ptr<SceneStage> ask_stage(std::string_view word) {
#define X(name)                                                                                    \
    if (word == #name)                                                                             \
        return name##_ask();
    BOXWOOD_SCENE_ASKS(X)
#undef X
    throw std::logic_error("no stage answers " + std::string(word));
}

} // namespace boxwood::bench
