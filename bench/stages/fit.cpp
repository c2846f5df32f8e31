#include "bench/stages/playing.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

/// The boxes of the bodies that have changed, in parts of 4096.
class Fit final : public SceneStage {
  public:
    Fit(bool boxes, bool wide) : with_boxes_(boxes), with_wide_(wide) {}

    std::size_t start(Playing& playing) override {
        const std::size_t n = playing.scene.bodies().size();
        if (with_boxes_)
            playing.boxes.resize(n);
        if (with_wide_)
            playing.wide_boxes.resize(n);
        fit(playing, n, [](std::size_t i) { return static_cast<std::uint32_t>(i); });
        return n;
    }
    std::size_t run(Playing& playing) override {
        const std::span<const std::uint32_t> changed = playing.changed;
        fit(playing, changed.size(), [&](std::size_t i) { return changed[i]; });
        return changed.size();
    }
    std::size_t bytes(const Playing& playing) const override {
        return bytes_of(playing.boxes) + bytes_of(playing.wide_boxes);
    }

  private:
    template <class BodyAt> void fit(Playing& playing, std::size_t n, const BodyAt& body_at) const {
        constexpr std::size_t part = 4096;
        playing.executor.for_each((n + part - 1) / part, [&](std::size_t p) {
            const std::size_t end = std::min(n, (p + 1) * part);
            for (std::size_t at = p * part; at < end; ++at)
                fit_one(playing, body_at(at));
        });
    }
    void fit_one(Playing& playing, std::uint32_t i) const {
        if (with_boxes_)
            playing.boxes[i] = fitted_box(playing.scene.bodies(), i);
        if (with_wide_)
            playing.wide_boxes[i] = pair_box(playing.scene, i);
    }

    bool with_boxes_, with_wide_;
};

} // namespace

std::unique_ptr<SceneStage> fit_stage(bool boxes, bool wide) {
    return std::make_unique<Fit>(boxes, wide);
}

} // namespace boxwood::bench
