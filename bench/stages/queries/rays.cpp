#include "bench/stages/surface.h"

namespace boxwood::bench {

std::unique_ptr<SceneStage> rays_query() {
    return running([](Playing& playing) {
        playing.surface->hits(playing.rays, playing.executor, playing.answers.rays);
        return playing.rays.size();
    });
}

} // namespace boxwood::bench
