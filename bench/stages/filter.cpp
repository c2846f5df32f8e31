#include "bench/stages/playing.h"

namespace boxwood::bench {
namespace {

/// Takes out the pairs that the scene ignores, by the ranges of bodies that they lie in.
class Filter final : public SceneStage {
  public:
    std::size_t run(Playing& playing) override {
        if (!playing.pairs_are_new)
            return 0;
        const std::size_t n = playing.pairs->size();
        std::erase_if(*playing.pairs, [&](Pair p) { return playing.scene.is_ignored(p.a, p.b); });
        return n;
    }
};

} // namespace

std::unique_ptr<SceneStage> filter_stage() { return std::make_unique<Filter>(); }

} // namespace boxwood::bench
