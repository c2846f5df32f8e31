#pragma once

#include "bench/tasks/detail/tree_contender.h"
#include "bench/tasks/detail/tree_task.h"
#include "kernels/primitives/ray.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// The orders in which rays may be handed over and traced: names of the key `ray_order`.
struct RayOrderEntry {
    std::string_view name, summary;
    std::string_view traversal; ///< its name in the registry
    std::vector<std::string> classes;
};
std::span<const RayOrderEntry> ray_orders();

/// A tree of a mesh and its triangles as the layout wants them.
class RayContender : public TreeContender {
  public:
    RayContender(const Job& job, BuildFunction build, const LayoutEntry& layout, std::string kernel)
        : TreeContender(job, std::move(build), layout), kernel_(std::move(kernel)) {}

    void build() override;
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{layout_->bytes() + triangles_.bytes(), &tree_};
    }

  protected:
    bool is_of_mesh() const override { return true; }

    std::string kernel_;
    TriangleBlocks triangles_;
};

/// A tree for each fan or mesh of the cases, and its rays.
class TreesOfCases : public Contender {
  public:
    TreesOfCases(const Job& job, const BuildFunction& build, const LayoutEntry& layout)
        : cases_(std::get<RayCases>(job.scene->cases)), build_(build), layout_(layout) {}

    void build() override;

  protected:
    struct Group {
        std::uint32_t first;   ///< of its triangles
        std::size_t first_ray; ///< of its rays
        std::unique_ptr<AnyLayout> layout;
        TriangleBlocks triangles;
        std::vector<Ray<float>> rays;
    };

    const RayCases& cases_;
    std::vector<Group> groups_;

  private:
    void add_group(const RayCase& c, std::size_t first_ray);

    BuildFunction build_;
    const LayoutEntry& layout_;
};

/// A task about the rays of a scene and the triangles of its mesh, with the keys rays, n_rays and
/// kernels. On the cases of closed fans and meshes each has a tree of its own, and kernels with a
/// promise are judged in every layout.
class RayTask : public TreeTask {
  public:
    std::vector<std::string_view> keys() const override;
    bool fits(const Cases& cases) const override;
    std::vector<ContenderEntry> contenders_on_cases() const override;
    std::optional<std::string> missing(const Scene& scene) const override;
    std::uint64_t n_queries(const Scene& scene) const override { return scene.rays.size(); }

  protected:
    std::string_view mesh_is_for() const override { return "aim rays at"; }
    std::vector<SceneSpec> with_queries(const BlockReader& block,
                                        const SceneSpec& scene) const override;
    std::vector<Choice> variants(const BlockReader& block, const Choice& choice) const override;
    std::optional<std::string> missing_on_device(const Scene& scene) const override;
    struct CaseWay {
        const char *builder, *ray_order;
    };
    /// How a kernel of such a promise is judged on cases.
    virtual std::vector<CaseWay> ways_on_cases(Promise promise) const = 0;
};

/// One hit of each ray: the nearest, or any; also with the key ray_order.
class HitTask : public RayTask {
  public:
    explicit HitTask(RayQuery query) : query_(query) {}

    std::vector<std::string_view> keys() const override;
    std::unique_ptr<Answers> make_answers() const override;
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override;
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override;

  protected:
    std::vector<Choice> variants(const BlockReader& block, const Choice& choice) const override;
    std::vector<CaseWay> ways_on_cases(Promise promise) const override;
    Way way(const Choice& choice) const override;

  private:
    Answering::Make on_device(const Choice& choice) const;

    RayQuery query_;
};

} // namespace boxwood::bench
