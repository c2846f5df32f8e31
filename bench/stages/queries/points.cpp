#include "bench/stages/playing.h"

#include "trees/queries/points.h"

namespace boxwood::bench {

std::unique_ptr<SceneStage> points_query() {
    return running([](Playing& playing) {
        playing.answers.points.clear();
        AppendPairs sink(playing.answers.points);
        boxwood::points(*playing.box_tree, playing.points, playing.executor, sink, nullptr);
        return playing.points.size();
    });
}

} // namespace boxwood::bench
