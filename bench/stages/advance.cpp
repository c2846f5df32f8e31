/// The stages that change bodies: one per effect laid, and the motion along velocities.

#include "bench/stages/playing.h"

#include <numeric>

namespace boxwood::bench {
namespace {

/// What the frame has changed, for the stages after this: not bodies that were absent and are,
/// whatever effects do to them, unless all stages run.
class FrameEnd {
  public:
    void start(const Playing& playing) {
        was_present_.clear();
        if (playing.scene.changes().presence && !playing.is_full())
            was_present_ = playing.scene.bodies().present;
    }
    void end(Playing& playing) {
        playing.changed = playing.scene.end_frame();
        if (!was_present_.empty())
            playing.changed = seen(playing);
        if (!playing.changed.empty())
            playing.last_change = playing.scene.frame();
    }
    std::size_t bytes() const { return bytes_of(was_present_) + bytes_of(seen_); }

  private:
    /// Without a branch on who is there.
    std::span<const std::uint32_t> seen(const Playing& playing) {
        const std::vector<std::uint8_t>& present = playing.scene.bodies().present;
        seen_.resize(present.size());
        std::size_t n = 0;
        for (const std::uint32_t body : playing.changed) {
            seen_[n] = body;
            n += (was_present_[body] | present[body]) != 0;
            was_present_[body] = present[body];
        }
        return std::span(seen_).first(n);
    }

    std::vector<std::uint8_t> was_present_; ///< by body, in the frame before; if that may change
    std::vector<std::uint32_t> seen_;
};

class Advance final : public SceneStage {
  public:
    Advance(std::size_t laid, bool ends) : laid_(laid), ends_(ends) {}
    std::size_t start(Playing& playing) override {
        if (ends_)
            end_.start(playing);
        return 0;
    }
    std::size_t run(Playing& playing) override {
        playing.scene.advance_effect(laid_);
        if (ends_)
            end_.end(playing);
        return playing.scene.effects()[laid_].chosen.size();
    }
    std::size_t bytes(const Playing&) const override { return end_.bytes(); }

  private:
    std::size_t laid_;
    bool ends_;
    FrameEnd end_;
};

/// Bodies with a velocity; of the extent all_stages, all.
class Move final : public SceneStage {
  public:
    std::size_t start(Playing& playing) override {
        if (playing.is_full() && all_.empty()) {
            all_.resize(playing.scene.bodies().size());
            std::iota(all_.begin(), all_.end(), 0u);
        }
        end_.start(playing);
        return 0;
    }
    std::size_t run(Playing& playing) override {
        const auto moving = playing.is_full() ? std::span<const std::uint32_t>(all_)
                                              : playing.scene.with_velocity();
        playing.scene.move(moving);
        end_.end(playing);
        if (playing.is_full())
            playing.changed = all_;
        return moving.size();
    }
    std::size_t bytes(const Playing&) const override { return bytes_of(all_) + end_.bytes(); }

  private:
    std::vector<std::uint32_t> all_;
    FrameEnd end_;
};

} // namespace

std::unique_ptr<SceneStage> advance_stage(std::size_t laid, bool ends) {
    return std::make_unique<Advance>(laid, ends);
}
std::unique_ptr<SceneStage> move_stage() { return std::make_unique<Move>(); }

} // namespace boxwood::bench
