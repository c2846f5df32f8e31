/// The stages transform and mesh_trees: the meshes of bodies that may meet, as they stand in the
/// scene.

#include "bench/stages/world_meshes.h"

namespace boxwood::bench {
namespace {

/// Vertices of bodies in candidate pairs that have changed since they were last transformed.
class Transform final : public SceneStage {
  public:
    std::size_t start(Playing& playing) override {
        meshes_ = std::make_unique<WorldMeshes>(playing.scene.bodies());
        playing.meshes = meshes_.get();
        return 0;
    }
    void note_changes(const Playing& playing) override {
        meshes_->note(playing.changed, playing.scene.frame());
    }
    std::size_t run(Playing& playing) override {
        if (!playing.pairs_are_new)
            return 0;
        meshes_->want(*playing.pairs, playing.is_full());
        return meshes_->transform(playing.scene.bodies(), playing.is_full(), playing.executor);
    }
    std::size_t bytes(const Playing&) const override {
        return meshes_ ? meshes_->vertex_bytes() : 0;
    }

  private:
    std::unique_ptr<WorldMeshes> meshes_;
};

class MeshTrees final : public SceneStage {
  public:
    std::size_t run(Playing& playing) override {
        return playing.pairs_are_new
                   ? playing.meshes->update_trees(playing.scene.bodies(), playing.is_full(),
                                                  playing.executor)
                   : 0;
    }
    std::size_t bytes(const Playing& playing) const override {
        return playing.meshes ? playing.meshes->tree_bytes() : 0;
    }
};

} // namespace

std::unique_ptr<SceneStage> transform_stage() { return std::make_unique<Transform>(); }
std::unique_ptr<SceneStage> mesh_trees_stage() { return std::make_unique<MeshTrees>(); }

} // namespace boxwood::bench
