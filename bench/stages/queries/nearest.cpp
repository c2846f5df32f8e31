#include "bench/stages/playing.h"

#include "trees/queries/points.h"

namespace boxwood::bench {

std::unique_ptr<SceneStage> nearest_query() {
    return running([](Playing& playing) {
        const std::size_t k = query_named(playing.scene.file(), "nearest")->k;
        playing.answers.nearest.resize(k * playing.places.size());
        boxwood::nearest(*playing.box_tree, playing.places, k, playing.executor,
                         playing.answers.nearest, nullptr);
        for (Neighbour& found : playing.answers.nearest) // a body that is absent is nobody's
            if (!(found.squared_distance < std::numeric_limits<double>::infinity()))
                found = {};
        return playing.places.size();
    });
}

} // namespace boxwood::bench
