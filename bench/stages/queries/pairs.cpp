#include "bench/stages/playing.h"

#include <optional>

namespace boxwood::bench {
namespace {

/// Of frames in which nothing has changed the pairs are those of the frame before.
class Pairs final : public SceneStage {
  public:
    std::size_t start(Playing& playing) override {
        playing.pairs =
            query_named(playing.scene.file(), "pairs") ? &playing.answers.pairs : &hidden_;
        sink_.emplace(*playing.pairs);
        is_found_ = false;
        return 0;
    }
    std::size_t run(Playing& playing) override {
        playing.pairs_are_new = !is_found_ || !playing.still_holds(found_in_);
        if (!playing.pairs_are_new)
            return 0;
        playing.pairs->clear();
        playing.tree->self_pairs(playing.executor, *sink_);
        is_found_ = true;
        found_in_ = playing.scene.frame();
        return playing.pairs->size();
    }
    std::size_t bytes(const Playing&) const override { return bytes_of(hidden_); }

  private:
    std::vector<Pair> hidden_; ///< if only the stages that follow need them
    std::optional<AppendPairs> sink_;
    bool is_found_ = false;
    std::uint64_t found_in_ = 0;
};

} // namespace

std::unique_ptr<SceneStage> pairs_query() { return std::make_unique<Pairs>(); }

} // namespace boxwood::bench
