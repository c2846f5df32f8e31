#pragma once

#include "scenes/moving/moving_scene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace boxwood {

/// The boxes of a moving scene at one moment, all of them, and which are not what they were.
struct Frame {
    std::vector<Aabb<float>> boxes;   ///< by body; the empty box of one that is not present
    std::vector<std::uint32_t> moved; ///< ascending: whose box is not that of the frame before
};

/// The boxes of all bodies as they stand, widened by the margins of their groups: those of a Frame.
std::vector<Aabb<float>> boxes_of(const MovingScene& scene);

/// Those of frame 0.
std::vector<Aabb<float>> boxes_at_start(const SceneFile& file);

/// The boxes of a moving scene, frame by frame: the same bits in each pass. They are made once and
/// held if the boxes of all frames take `max_bytes` at most, else made again in each pass; then
/// memory does not grow with their number.
class Frames {
  public:
    static constexpr std::size_t max_baked = std::size_t{256} << 20;

    explicit Frames(std::shared_ptr<const SceneFile> file, std::size_t max_bytes = max_baked);

    /// The number of frames that follow the start.
    std::size_t size() const { return file_->frames; }
    std::span<const Aabb<float>> start() const { return start_; }
    /// Frame 1, 2, ... size(), good until the next call, then nullptr.
    const Frame* next();
    /// Back to the start: frame 1 comes next.
    void rewind();

    /// Memory held now.
    std::size_t bytes() const;

  private:
    void bake(const Recording& recording);

    std::shared_ptr<const SceneFile> file_;
    bool is_baked_ = false;
    std::size_t played_ = 0;
    std::vector<Aabb<float>> start_;
    std::vector<Frame> baked_;
    std::unique_ptr<MovingScene> scene_; ///< where it is streamed
    Frame now_;
};

/// XXH3 of the boxes of the start and of every frame, in one pass from the start; it then stands
/// at the start again.
std::uint64_t content_hash(Frames& frames);

/// Its effects, group by group, and its frames per second, as one JSON object.
std::string params_json(const SceneFile& file);
/// The names of its effects and of its queries, each once, comma-separated.
std::string effect_names(const SceneFile& file);
std::string query_names(const SceneFile& file);

} // namespace boxwood
