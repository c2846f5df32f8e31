#include "bench/stages/playing.h"

namespace boxwood::bench {
namespace {

/// Lays the queries of the frame.
class Aim final : public SceneStage {
  public:
    std::size_t run(Playing& playing) override {
        const MovingScene& scene = playing.scene;
        std::size_t n = 0;
        for (const SceneQuery& ask : scene.file().queries) {
            if (ask.name == "rays")
                rays_of_frame(scene, ask, playing.rays);
            else if (ask.name == "points")
                points_of_frame(scene, ask, playing.points);
            else if (ask.name == "nearest")
                points_of_frame(scene, ask, playing.places);
            else if (ask.name == "regions")
                regions_of_frame(scene, ask, playing.regions);
            n += ask.n;
        }
        return n;
    }
    std::size_t bytes(const Playing& playing) const override {
        return bytes_of(playing.rays) + bytes_of(playing.points) + bytes_of(playing.places) +
               bytes_of(playing.regions);
    }
};

} // namespace

std::unique_ptr<SceneStage> aim_stage() { return std::make_unique<Aim>(); }

} // namespace boxwood::bench
