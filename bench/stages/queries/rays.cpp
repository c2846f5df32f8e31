#include "bench/stages/surface.h"

namespace boxwood::bench {
namespace {

class Rays final : public SceneStage {
  public:
    std::size_t run(Playing& playing) override {
        playing.surface->hits(playing.rays, playing.executor, playing.answers.rays);
        return playing.rays.size();
    }
};

} // namespace

std::unique_ptr<SceneStage> rays_query() { return std::make_unique<Rays>(); }

} // namespace boxwood::bench
