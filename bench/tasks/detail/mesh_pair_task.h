#pragma once

#include "bench/tasks/detail/mesh_pair_answers.h"
#include "bench/tasks/task.h"
#include "trees/world/mesh_pairs.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// The tree of the scene's mesh, which stands for its copy, too, unless that is another mesh.
class MeshPairContender : public Contender {
  public:
    MeshPairContender(const Job& job, BuildFunction build, MeshVolume volume)
        : scene_(*job.scene), build_(std::move(build)), volume_(volume) {}

    void build() override {
        tree_.reset();
        other_.reset();
        tree_.emplace(scene_.mesh, MeshTreeOptions{build_, volume_});
        if (scene_.has_other_copy())
            other_.emplace(scene_.copy(), MeshTreeOptions{build_, volume_});
    }
    void query(Answers& answers) override { run(answers, nullptr); }
    std::optional<Work> counted_query(Answers& answers) override {
        Work work;
        run(answers, &work);
        return work;
    }
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{.bytes = tree_->bytes() + (other_ ? other_->bytes() : 0)};
    }

  protected:
    virtual void run(Answers& answers, Work* work) = 0;
    const MeshTree& mesh() const { return *tree_; }
    const MeshTree& copy() const { return other_ ? *other_ : *tree_; }

    const Scene& scene_;

  private:
    std::optional<MeshTree> tree_, other_; ///< of the mesh, and of a copy that is another one
    BuildFunction build_;
    MeshVolume volume_;
};

/// A task about a mesh and a copy of it in the scene's poses, which the contender
/// "<builder>.<volume>.<query>" answers, or a variant of it. Keys: scene, n, poses, n_poses,
/// builders, volumes, peers.
class MeshPairTask : public Task {
  public:
    std::vector<std::string_view> keys() const override;
    SceneKind scenes() const override { return SceneKind::still; }
    void expand(const BlockReader& block, AddCell add) const override;
    ContenderEntry contender(const Choice& choice) const override;
    std::optional<std::string> missing(const Scene& scene) const override;
    std::uint64_t n_queries(const Scene& scene) const override { return scene.poses.size(); }

  protected:
    using Make = std::function<std::unique_ptr<Contender>(const Job& job, BuildFunction build,
                                                          MeshVolume volume)>;
    virtual Make make(const Choice& choice) const = 0;
    virtual Promise promise() const = 0;
    virtual RunsOn runs_on() const { return RunsOn::one_thread; }
    /// The variants of a query that the block wants, of each builder and volume.
    virtual std::vector<Choice> variants(const BlockReader&) const { return {Choice{}}; }
    /// Adds the variant to an entry: to its name, notes, class and parameters.
    virtual void add_variant(const Choice&, ContenderEntry&) const {}
    /// What a query is of, for the notes.
    virtual std::string_view query_notes() const { return "pose after pose"; }
    /// The kinds of poses of a block that names none.
    virtual std::vector<std::string> usual_poses() const {
        return {"apart", "near", "shallow", "deep"};
    }
    /// The scenes of a block: each that it names, in each kind of poses.
    virtual std::vector<SceneSpec> posed_scenes(const BlockReader& block) const;
};

template <class C>
std::unique_ptr<Contender> mesh_pair_contender(const Job& job, BuildFunction build,
                                               MeshVolume volume) {
    return std::make_unique<C>(job, std::move(build), volume);
}

} // namespace boxwood::bench
