#pragma once

#include "scenes/effects/effect.h"
#include "scenes/moving/scene_file.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

namespace boxwood {

/// Bodies [first, last) of one group of which pairs are expected and left out: those of neighbours
/// i, i + 1, or all.
struct IgnoredPairs {
    std::uint32_t first, last;
    bool all;

    constexpr bool has(std::uint32_t a, std::uint32_t b) const {
        return first <= a && b < last && (all || b == a + 1);
    }
};

/// Bodies [first, last), whose boxes are widened for pairs.
struct Margin {
    std::uint32_t first, last;
    double margin; ///< scene units, on every side
};

/// A scene that is played frame by frame: the same bits on every machine. It holds the present
/// frame alone, whatever their number. Nothing is done for what its effects do not change: an
/// effect that is laid on no body, or on none that it can change, is not there.
class MovingScene {
  public:
    /// An effect laid on some bodies.
    struct Laid {
        const EffectEntry* entry;
        std::vector<std::uint32_t> chosen; ///< ascending, not empty
        std::unique_ptr<RunningEffect> effect;
        Random random;
    };

    /// Frame 0. n: instead of the file's, if given. Throws std::invalid_argument for a scene of
    /// more than 2^32 - 1 bodies. can_rewind: a copy of the bodies is kept for it.
    explicit MovingScene(SceneFile file, std::optional<std::size_t> n = {},
                         bool can_rewind = false);

    const SceneFile& file() const { return file_; }
    const Bodies& bodies() const { return bodies_; }
    std::uint64_t frame() const { return frame_; }
    /// What any of its effects changes.
    Changes changes() const { return changes_; }
    /// In the order in which they act.
    std::span<const Laid> effects() const { return effects_; }
    /// Bodies to which an effect gives a velocity, ascending.
    std::span<const std::uint32_t> with_velocity() const { return with_velocity_; }

    /// Pairs of bodies that are expected and left out; a < b.
    std::span<const IgnoredPairs> ignored() const { return ignored_; }
    bool is_ignored(std::uint32_t a, std::uint32_t b) const {
        return std::ranges::any_of(ignored_, [&](const IgnoredPairs& i) { return i.has(a, b); });
    }
    std::span<const Margin> margins() const { return margins_; }

    /// To the next frame. Gives the bodies whose box may be another, ascending.
    std::span<const std::uint32_t> advance();

    // The steps of `advance`, for who looks between them: begin_frame, then advance_effect of each
    // of effects(), then move, then end_frame.
    void begin_frame();
    void advance_effect(std::size_t i);
    /// What advance_effect does to each of the chosen bodies, if it is a step of each alone.
    std::optional<BodyStep> step(std::size_t i);
    /// What move does.
    MoveStep move_step() const;
    /// These bodies along their velocities: with_velocity() or more.
    void move(std::span<const std::uint32_t> bodies);
    std::span<const std::uint32_t> end_frame();

    /// Back to frame 0. Throws std::logic_error unless it can.
    void rewind();

  private:
    void add_group(const BodyGroup& group, std::size_t index);
    void lay_effects(const BodyGroup& group, std::size_t index, std::uint32_t first,
                     std::uint32_t last);
    void own_meshes(std::span<const std::uint32_t> bodies);
    void start_effects();
    Moment moment_of(const Laid& laid);

    SceneFile file_;
    Bodies bodies_;
    Changed changed_{0};
    Changes changes_;
    std::vector<Laid> effects_;
    std::vector<std::uint32_t> with_velocity_;
    std::vector<IgnoredPairs> ignored_;
    std::vector<Margin> margins_;
    std::uint64_t frame_ = 0;
    std::unique_ptr<const Bodies> unmoved_; ///< before any effect; null: it cannot rewind
};

/// The box of body i as pairs see it: widened by the margin of its group, so that it contains all
/// points within that of its box along each axis.
Aabb<float> pair_box(const MovingScene& scene, std::uint32_t i);

} // namespace boxwood
