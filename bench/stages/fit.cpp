#include "bench/stages/playing.h"
#include "bench/stages/turned_box.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

/// The boxes of the bodies that have changed, in parts of 4096. What turns nothing turns no box.
class Fit final : public SceneStage {
  public:
    Fit(bool boxes, bool wide) : with_boxes_(boxes), with_wide_(wide) {}

    std::size_t start(Playing& playing) override {
        const std::size_t n = playing.scene.bodies().size();
        if (with_boxes_)
            playing.boxes.resize(n);
        if (with_wide_)
            playing.wide_boxes.resize(n);
        turned_.clear();
        if (!playing.is_full() && only_shifts(playing.scene))
            for (std::size_t i = 0; i < n; ++i)
                turned_.emplace_back(playing.scene.bodies().pose[i].rotation,
                                     playing.scene.bodies().rest[i]);
        fit(playing, n, [](std::size_t i) { return static_cast<std::uint32_t>(i); });
        return n;
    }
    std::size_t run(Playing& playing) override {
        const std::span<const std::uint32_t> changed = playing.changed;
        fit(playing, changed.size(), [&](std::size_t i) { return changed[i]; });
        return changed.size();
    }
    std::size_t bytes(const Playing& playing) const override {
        return bytes_of(playing.boxes) + bytes_of(playing.wide_boxes) + bytes_of(turned_);
    }

  private:
    template <class BodyAt> void fit(Playing& playing, std::size_t n, const BodyAt& body_at) const {
        constexpr std::size_t part = 4096;
        playing.executor.for_each((n + part - 1) / part, [&](std::size_t p) {
            const std::size_t end = std::min(n, (p + 1) * part);
            without_flushing([&] {
                for (std::size_t at = p * part; at < end; ++at)
                    fit_one(playing, body_at(at));
            });
        });
    }
    /// Whether bodies move but do not turn or change their shape, and enough of them to note what
    /// stays.
    bool only_shifts(const MovingScene& scene) const {
        const Changes changes = scene.changes();
        if (!with_boxes_ || changes.rotation || changes.shape)
            return false;
        const Bodies& bodies = scene.bodies();
        return std::ranges::any_of(scene.effects(),
                                   [&](const MovingScene::Laid& laid) {
                                       const Changes own = laid.entry->changes;
                                       return (own.position || own.velocity) &&
                                              laid.chosen.size() >= bodies.size() / 4;
                                   }) &&
               std::ranges::none_of(bodies.rest, &Aabb<float>::is_empty);
    }
    void fit_one(Playing& playing, std::uint32_t i) const {
        const Bodies& bodies = playing.scene.bodies();
        if (with_boxes_ && turned_.empty())
            playing.boxes[i] = fitted_box(bodies, i);
        else if (with_boxes_)
            playing.boxes[i] =
                bodies.present[i] ? turned_[i].at(bodies.pose[i].translation) : Box{};
        if (with_wide_)
            playing.wide_boxes[i] = pair_box(playing.scene, i);
    }

    bool with_boxes_, with_wide_;
    std::vector<TurnedBox> turned_; ///< by body, if bodies only shift
};

} // namespace

std::unique_ptr<SceneStage> fit_stage(bool boxes, bool wide) {
    return std::make_unique<Fit>(boxes, wide);
}

} // namespace boxwood::bench
