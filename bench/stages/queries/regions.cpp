#include "bench/stages/playing.h"

#include "trees/queries/regions.h"

namespace boxwood::bench {

std::unique_ptr<SceneStage> regions_query() {
    return running([](Playing& playing) {
        playing.answers.regions.clear();
        AppendPairs sink(playing.answers.regions);
        boxwood::regions(*playing.box_tree, playing.regions, playing.executor, sink, nullptr);
        return playing.regions.size();
    });
}

} // namespace boxwood::bench
