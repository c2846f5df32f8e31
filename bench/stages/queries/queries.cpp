/// The stages of what a scene may query. To add a query: its row in scenes/moving/query.cpp, the
/// file NAME.cpp here, which defines `std::unique_ptr<SceneStage> NAME_query()`, its name here, and
/// its lines in plan_stages.cpp, scene_player.cpp and aim.cpp.

#include "bench/stages/playing.h"

#include <stdexcept>
#include <string>

#define BOXWOOD_SCENE_QUERIES(X) X(pairs) X(triangle_pairs) X(rays) X(points) X(regions) X(nearest)

namespace boxwood::bench {

#define X(name) std::unique_ptr<SceneStage> name##_query();
BOXWOOD_SCENE_QUERIES(X)
#undef X

std::unique_ptr<SceneStage> query_stage(std::string_view wanted) {
#define X(name)                                                                                    \
    if (wanted == #name)                                                                           \
        return name##_query();
    BOXWOOD_SCENE_QUERIES(X)
#undef X
    throw std::logic_error("no stage answers " + std::string(wanted));
}

} // namespace boxwood::bench
