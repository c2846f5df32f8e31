#pragma once

#include "scenes/moving/effect.h"
#include "scenes/moving/scene_file.h"

#include <memory>
#include <optional>
#include <vector>

namespace boxwood {

/// A scene that is played frame by frame: the same bits on every machine. It holds the present
/// frame alone, whatever their number. Nothing is done for what its effects do not change.
class MovingScene {
  public:
    /// Frame 0. n: instead of the file's, if given. Throws std::invalid_argument for a scene of
    /// more than 2^32 - 1 bodies.
    explicit MovingScene(SceneFile file, std::optional<std::size_t> n = {});

    const SceneFile& file() const { return file_; }
    const Bodies& bodies() const { return bodies_; }
    std::uint64_t frame() const { return frame_; }
    /// What any of its effects changes.
    Changes changes() const { return changes_; }
    /// Pairs of bodies that are expected and left out, lower first, ascending.
    std::span<const std::array<std::uint32_t, 2>> expected_pairs() const { return expected_; }

    /// To the next frame. Gives the bodies whose box may be another, ascending.
    std::span<const std::uint32_t> advance();

  private:
    struct Laid {
        std::unique_ptr<RunningEffect> effect;
        std::vector<std::uint32_t> chosen;
        Random random;
    };

    void add_group(const BodyGroup& group, std::size_t index);
    void lay_effects(const BodyGroup& group, std::size_t index, std::uint32_t first,
                     std::uint32_t last);
    Moment moment_of(const Laid& laid);
    void move_along(std::uint32_t body);

    SceneFile file_;
    Bodies bodies_;
    Changed changed_{0};
    Changes changes_;
    std::vector<Laid> effects_;
    std::vector<std::uint32_t> with_velocity_; ///< bodies whose effects give them one
    std::vector<std::array<std::uint32_t, 2>> expected_;
    std::uint64_t frame_ = 0;
};

} // namespace boxwood
