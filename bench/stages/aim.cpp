#include "bench/stages/playing.h"

namespace boxwood::bench {
namespace {

/// Lays the queries of the frame.
class Aim final : public SceneStage {
  public:
    std::size_t run(Playing& playing) override {
        const MovingScene& scene = playing.scene;
        std::size_t n = 0;
        for (const SceneQuery& query : scene.file().queries) {
            if (query.name == "rays")
                rays_of_frame(scene, query, playing.rays);
            else if (query.name == "points")
                points_of_frame(scene, query, playing.points);
            else if (query.name == "nearest")
                points_of_frame(scene, query, playing.places);
            else if (query.name == "regions")
                regions_of_frame(scene, query, playing.regions);
            n += query.n;
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
