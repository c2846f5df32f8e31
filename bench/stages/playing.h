#pragma once

#include "bench/stages/device_bodies.h"
#include "bench/stages/frame_answers.h"
#include "bench/stages/plan_stages.h"
#include "scenes/moving/moving_scene.h"
#include "trees/device.h"
#include "trees/dynamic/update.h"
#include "trees/executor.h"
#include "trees/layouts/packed.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace boxwood::bench {

class Surface;
class WorldMeshes;

/// What is on the device that a scene is played on.
struct OnDevice {
    DevicePlace place;
    std::unique_ptr<DeviceBodies> bodies{}; ///< upload, of bodies that stay there
    DeviceSpan<const Box> boxes{};          ///< upload, or fit
    std::optional<DeviceBvh> tree{};        ///< tree, update
    DeviceArray<Pair> pairs{};              ///< pairs
};

/// What the stages of one scene hand on to each other. What belongs to a stage that is not made
/// stays empty or null.
struct Playing {
    MovingScene scene;
    const Executor& executor;
    Extent extent;

    /// Of the present frame; of the extent all_stages, of all bodies.
    std::span<const std::uint32_t> changed{};
    std::uint64_t last_change = 0; ///< the last frame that changed a body; 0: none has

    std::vector<Box> boxes{};                    ///< fit
    std::vector<Box> wide_boxes{};               ///< fit: by the margins, for pairs
    std::unique_ptr<Updater> tree{};             ///< tree, update: over pair_boxes()
    const PackedLayout* box_tree = nullptr;      ///< box_tree: over boxes
    std::vector<Pair>* pairs = nullptr;          ///< pairs, filter
    bool pairs_are_new = false;                  ///< found in this frame, not those of one before
    WorldMeshes* meshes = nullptr;               ///< transform, mesh_trees
    const Surface* surface = nullptr;            ///< surface
    std::vector<Ray<float>> rays{};              ///< aim
    std::vector<Vec3<float>> points{}, places{}; ///< aim: of points and of nearest
    std::vector<Box> regions{};                  ///< aim
    std::unique_ptr<OnDevice> device{};          ///< null where none is played on
    FrameAnswers answers{};

    bool is_full() const { return extent == Extent::all_stages; }
    std::span<const Box> pair_boxes() const { return wide_boxes.empty() ? boxes : wide_boxes; }
    /// Whether what was made in that frame is still so: never of the extent all_stages.
    bool still_holds(std::uint64_t frame) const { return !is_full() && last_change <= frame; }
};

/// A stage of the plan. Each gives the number of items that it handled. Stages that make something
/// of the start do so in `start`, which may come again.
class SceneStage {
  public:
    virtual ~SceneStage() = default;
    virtual std::size_t start(Playing&) { return 0; }
    virtual std::size_t run(Playing&) { return 0; }
    /// For a stage that runs with the queries, and must know what frames before have
    /// changed.
    virtual void note_changes(const Playing&) {}
    /// Memory that the stage holds; what it answers does not count.
    virtual std::size_t bytes(const Playing&) const { return 0; }
};

/// A stage that does no more than `run`, each time.
template <class Run> std::unique_ptr<SceneStage> running(Run run) {
    class Stage final : public SceneStage {
      public:
        explicit Stage(Run f) : f_(f) {}
        std::size_t run(Playing& playing) override { return f_(playing); }

      private:
        Run f_;
    };
    return std::make_unique<Stage>(run);
}

template <class T> std::size_t bytes_of(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}

/// The stage advance_<effect> of one effect laid; `ends`: no stage after it changes bodies.
std::unique_ptr<SceneStage> advance_stage(std::size_t laid, bool ends);
std::unique_ptr<SceneStage> move_stage();
/// boxes, wide: which boxes are wanted: those of the bodies, those widened by margins.
std::unique_ptr<SceneStage> fit_stage(bool boxes, bool wide);
std::unique_ptr<SceneStage> tree_stage();
std::unique_ptr<SceneStage> update_stage();
std::unique_ptr<SceneStage> box_tree_stage();
std::unique_ptr<SceneStage> filter_stage();
std::unique_ptr<SceneStage> transform_stage();
std::unique_ptr<SceneStage> mesh_trees_stage();
std::unique_ptr<SceneStage> surface_stage();
std::unique_ptr<SceneStage> aim_stage();

/// The same on a device: bench/stages/device_stages.cpp. upload_bodies: once, to stay there;
/// upload_boxes: of each frame; download: pairs.
std::unique_ptr<SceneStage> upload_bodies_stage();
std::unique_ptr<SceneStage> upload_boxes_stage();
std::unique_ptr<SceneStage> advance_there_stage(std::size_t laid);
std::unique_ptr<SceneStage> move_there_stage();
std::unique_ptr<SceneStage> fit_there_stage();
std::unique_ptr<SceneStage> tree_there_stage();
std::unique_ptr<SceneStage> update_there_stage();
std::unique_ptr<SceneStage> pairs_there_stage();
std::unique_ptr<SceneStage> download_stage();

/// The stage of a name of `scene_queries()`: bench/stages/queries/NAME.cpp.
std::unique_ptr<SceneStage> query_stage(std::string_view name);

} // namespace boxwood::bench
