#include "bench/stages/playing.h"

#include "trees/queries/points.h"

namespace boxwood::bench {
namespace {

class Points final : public SceneStage {
  public:
    std::size_t run(Playing& playing) override {
        playing.answers.points.clear();
        AppendPairs sink(playing.answers.points);
        boxwood::points(*playing.box_tree, playing.points, playing.executor, sink, nullptr);
        return playing.points.size();
    }
};

} // namespace

std::unique_ptr<SceneStage> points_query() { return std::make_unique<Points>(); }

} // namespace boxwood::bench
