/// What runs on a device, and what crosses to it and back.

#include "bench/stages/playing.h"

#include <functional>
#include <utility>

namespace boxwood::bench {
namespace {

using Work = std::function<std::size_t(Playing&)>;

/// A stage that does no more than `start` and `run`. It waits for the device, so that its time is
/// its own.
class There final : public SceneStage {
  public:
    There(Work start, Work run) : start_(std::move(start)), run_(std::move(run)) {}
    std::size_t start(Playing& playing) override { return waited(playing, start_); }
    std::size_t run(Playing& playing) override { return waited(playing, run_); }

  private:
    static std::size_t waited(Playing& playing, const Work& work) {
        const std::size_t items = work ? work(playing) : 0;
        wait_for(playing.device->place);
        return items;
    }

    Work start_, run_;
};

/// What crossed, in bytes since the start.
class Crossing : public SceneStage {
  public:
    std::size_t bytes(const Playing&) const final { return bytes_; }

  protected:
    std::size_t bytes_ = 0;
};

/// Bodies that stay there, once.
class UploadBodies final : public Crossing {
  public:
    std::size_t start(Playing& playing) override {
        OnDevice& there = *playing.device;
        if (!there.bodies)
            there.bodies = make_device_bodies(there.place);
        bytes_ = there.bodies->upload(playing.scene);
        return playing.scene.bodies().size();
    }
};

/// The boxes of every frame that changed one.
class UploadBoxes final : public Crossing {
  public:
    std::size_t start(Playing& playing) override {
        bytes_ = 0;
        return upload(playing);
    }
    std::size_t run(Playing& playing) override {
        return playing.changed.empty() ? 0 : upload(playing);
    }

  private:
    std::size_t upload(Playing& playing) {
        const std::span<const Box> boxes = playing.pair_boxes();
        if (boxes_.size() != boxes.size())
            boxes_ = DeviceArray<Box>(boxes.size(), playing.device->place);
        boxes_.write(boxes);
        bytes_ += boxes.size_bytes();
        playing.device->boxes = boxes_.span();
        return boxes.size();
    }

    DeviceArray<Box> boxes_;
};

/// The host does not know which bodies changed.
void note_change(Playing& playing) { playing.last_change = playing.scene.frame(); }

std::size_t fit_all(Playing& playing) {
    playing.device->boxes = playing.device->bodies->fit();
    return playing.device->boxes.size;
}
std::size_t make_tree(Playing& playing) {
    OnDevice& there = *playing.device;
    if (there.tree)
        there.tree->rebuild(there.boxes);
    else
        there.tree.emplace(there.boxes, DeviceBvhOptions{.place = there.place});
    return there.boxes.size;
}
std::size_t make_tree_if_changed(Playing& playing) {
    return playing.last_change == playing.scene.frame() ? make_tree(playing) : 0;
}

/// As bench/stages/queries/pairs.cpp, but for the answers, which stay there.
class PairsThere final : public SceneStage {
  public:
    std::size_t start(Playing&) override {
        is_found_ = false;
        return 0;
    }
    std::size_t run(Playing& playing) override {
        OnDevice& there = *playing.device;
        playing.pairs_are_new = !is_found_ || !playing.still_holds(found_in_);
        if (!playing.pairs_are_new)
            return 0;
        there.pairs = {}; // not two lists at the same time
        there.pairs = there.tree->self_pairs_on_device();
        wait_for(there.place);
        is_found_ = true;
        found_in_ = playing.scene.frame();
        return there.pairs.size();
    }

  private:
    bool is_found_ = false;
    std::uint64_t found_in_ = 0;
};

/// So that the host has them.
class DownloadPairs final : public Crossing {
  public:
    std::size_t start(Playing& playing) override {
        playing.pairs =
            query_named(playing.scene.file(), "pairs") ? &playing.answers.pairs : &hidden_;
        bytes_ = 0;
        return 0;
    }
    std::size_t run(Playing& playing) override {
        if (!playing.pairs_are_new)
            return 0;
        playing.device->pairs.read(*playing.pairs);
        bytes_ += playing.pairs->size() * sizeof(Pair);
        return playing.pairs->size();
    }

  private:
    std::vector<Pair> hidden_; ///< if only the stages that follow need them
};

} // namespace

std::unique_ptr<SceneStage> upload_bodies_stage() { return std::make_unique<UploadBodies>(); }
std::unique_ptr<SceneStage> upload_boxes_stage() { return std::make_unique<UploadBoxes>(); }
std::unique_ptr<SceneStage> download_stage() { return std::make_unique<DownloadPairs>(); }

std::unique_ptr<SceneStage> advance_there_stage(std::size_t laid) {
    return std::make_unique<There>(Work{}, [laid](Playing& playing) {
        playing.device->bodies->advance(playing.scene, laid);
        note_change(playing);
        return playing.scene.effects()[laid].chosen.size();
    });
}
std::unique_ptr<SceneStage> move_there_stage() {
    return std::make_unique<There>(Work{}, [](Playing& playing) {
        playing.device->bodies->move(playing.scene);
        note_change(playing);
        return playing.scene.with_velocity().size();
    });
}
std::unique_ptr<SceneStage> fit_there_stage() { return std::make_unique<There>(fit_all, fit_all); }
std::unique_ptr<SceneStage> tree_there_stage() {
    return std::make_unique<There>(make_tree, Work{});
}
std::unique_ptr<SceneStage> update_there_stage() {
    return std::make_unique<There>(Work{}, make_tree_if_changed);
}
std::unique_ptr<SceneStage> pairs_there_stage() { return std::make_unique<PairsThere>(); }

} // namespace boxwood::bench
