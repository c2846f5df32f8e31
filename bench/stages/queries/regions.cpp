#include "bench/stages/playing.h"

#include "trees/queries/regions.h"

namespace boxwood::bench {
namespace {

class Regions final : public SceneStage {
  public:
    std::size_t run(Playing& playing) override {
        playing.answers.regions.clear();
        AppendPairs sink(playing.answers.regions);
        boxwood::regions(*playing.box_tree, playing.regions, playing.executor, sink, nullptr);
        return playing.regions.size();
    }
};

} // namespace

std::unique_ptr<SceneStage> regions_query() { return std::make_unique<Regions>(); }

} // namespace boxwood::bench
