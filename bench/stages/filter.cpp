#include "bench/stages/playing.h"

namespace boxwood::bench {

/// Takes out the pairs that the scene ignores, by the ranges of bodies that they lie in.
std::unique_ptr<SceneStage> filter_stage() {
    return running([](Playing& playing) -> std::size_t {
        if (!playing.pairs_are_new)
            return 0;
        const std::size_t n = playing.pairs->size();
        std::erase_if(*playing.pairs, [&](Pair p) { return playing.scene.is_ignored(p.a, p.b); });
        return n;
    });
}

} // namespace boxwood::bench
