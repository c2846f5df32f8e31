/// The tree that pairs are found with: made at the start, then given what has changed.

#include "bench/stages/playing.h"

namespace boxwood::bench {
namespace {

class MakeTree final : public SceneStage {
  public:
    std::size_t start(Playing& playing) override {
        if (!playing.tree)
            playing.tree = find_update(policy(playing)).make({});
        playing.tree->start(playing.pair_boxes(), playing.executor);
        return playing.tree->size();
    }
    std::size_t bytes(const Playing& playing) const override { return playing.tree->bytes(); }

  private:
    /// Of the extent all_stages, pairs are found again in every frame; without motion, once.
    static std::string_view policy(const Playing& playing) {
        if (playing.is_full())
            return "merge";
        return playing.scene.effects().empty() ? "refit" : "auto";
    }
};

} // namespace

std::unique_ptr<SceneStage> tree_stage() { return std::make_unique<MakeTree>(); }
std::unique_ptr<SceneStage> update_stage() {
    return running([](Playing& playing) {
        if (!playing.changed.empty())
            playing.tree->update(playing.pair_boxes(), playing.changed, playing.executor);
        return playing.changed.size();
    });
}

} // namespace boxwood::bench
