/// The tree that answers points, regions and nearest: over the boxes as they are.

#include "bench/stages/playing.h"

#include "trees/builders/hilbert.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

/// Refitted where bodies have changed; ordered again once the excess of the blocks' surface, added
/// up over frames, is that of the policy `auto`.
class BoxTree final : public SceneStage {
  public:
    std::size_t start(Playing& playing) override {
        playing.box_tree = &layout_;
        order_again(playing);
        return layout_.size();
    }
    std::size_t run(Playing& playing) override {
        const std::span<const std::uint32_t> changed = playing.changed;
        if (changed.empty())
            return 0;
        if (changed.size() < layout_.size() / 16) {
            note_slots();
            slots_.resize(changed.size());
            std::ranges::transform(changed, slots_.begin(),
                                   [&](std::uint32_t item) { return slot_of_[item]; });
            layout_.refit(playing.boxes, slots_);
        } else {
            layout_.refit(playing.boxes, playing.executor);
        }
        moved_ += changed.size();
        ++frames_;
        if (moved_ >= layout_.size() / 16)
            look_at_surface(playing);
        return changed.size();
    }
    std::size_t bytes(const Playing&) const override {
        return layout_.bytes() + bytes_of(slot_of_) + bytes_of(slots_);
    }

  private:
    static constexpr double patience = .4;

    /// Bodies that are absent have the place in the order of where they would be, and no box.
    void order_again(Playing& playing) {
        const Bodies& bodies = playing.scene.bodies();
        const std::vector<Box>* boxes = &playing.boxes;
        std::vector<Box> placed;
        if (std::ranges::find(bodies.present, 0) != bodies.present.end()) {
            placed = *boxes;
            for (std::size_t i = 0; i < placed.size(); ++i)
                if (placed[i].is_empty()) {
                    const auto at = static_cast<Vec3<float>>(bodies.pose[i].translation);
                    placed[i] = {at, at};
                }
            boxes = &placed;
        }
        const auto order = HilbertBuilder{}.order(*boxes, playing.executor);
        layout_.take(playing.boxes, order.span(), playing.executor);
        slot_of_.clear();
        tight_ = layout_.surface();
        excess_ = 0;
        moved_ = 0;
        frames_ = 0;
    }
    /// All blocks are looked at, hence not in every frame if few bodies move.
    void look_at_surface(Playing& playing) {
        const double surface = layout_.surface();
        if (tight_ > 0)
            excess_ += frames_ * (surface / tight_ - 1);
        else if (surface > 0) // all were absent, or in one block
            excess_ = patience;
        moved_ = 0;
        frames_ = 0;
        if (!(excess_ < patience))
            order_again(playing);
    }
    void note_slots() {
        if (!slot_of_.empty())
            return;
        slot_of_.resize(layout_.size());
        for (std::uint32_t slot = 0; slot < layout_.size(); ++slot)
            slot_of_[layout_.items()[slot]] = slot;
    }

    PackedLayout layout_;
    std::vector<std::uint32_t> slot_of_; ///< by body, if it is known
    std::vector<std::uint32_t> slots_;
    double tight_ = 0, excess_ = 0;
    std::size_t moved_ = 0; ///< since the surface was last looked at
    double frames_ = 0;     ///< the same
};

} // namespace

std::unique_ptr<SceneStage> box_tree_stage() { return std::make_unique<BoxTree>(); }

} // namespace boxwood::bench
