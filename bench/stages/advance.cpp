/// The stages that change bodies: one per effect laid, and the motion along velocities.

#include "bench/stages/playing.h"

#include <numeric>

namespace boxwood::bench {
namespace {

/// What the frame has changed, for the stages after this.
void end_frame(Playing& playing) {
    playing.changed = playing.scene.end_frame();
    if (!playing.changed.empty())
        playing.last_change = playing.scene.frame();
}

class Advance final : public SceneStage {
  public:
    Advance(std::size_t laid, bool ends) : laid_(laid), ends_(ends) {}
    std::size_t run(Playing& playing) override {
        playing.scene.advance_effect(laid_);
        if (ends_)
            end_frame(playing);
        return playing.scene.effects()[laid_].chosen.size();
    }

  private:
    std::size_t laid_;
    bool ends_;
};

/// Bodies with a velocity; with everything on, all.
class Move final : public SceneStage {
  public:
    std::size_t start(Playing& playing) override {
        if (playing.is_everything() && all_.empty()) {
            all_.resize(playing.scene.bodies().size());
            std::iota(all_.begin(), all_.end(), 0u);
        }
        return 0;
    }
    std::size_t run(Playing& playing) override {
        const auto moving = playing.is_everything() ? std::span<const std::uint32_t>(all_)
                                                    : playing.scene.with_velocity();
        playing.scene.move(moving);
        end_frame(playing);
        if (playing.is_everything())
            playing.changed = all_;
        return moving.size();
    }
    std::size_t bytes(const Playing&) const override { return bytes_of(all_); }

  private:
    std::vector<std::uint32_t> all_;
};

} // namespace

std::unique_ptr<SceneStage> advance_stage(std::size_t laid, bool ends) {
    return std::make_unique<Advance>(laid, ends);
}
std::unique_ptr<SceneStage> move_stage() { return std::make_unique<Move>(); }

} // namespace boxwood::bench
