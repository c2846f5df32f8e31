#pragma once

#include "trees/layout.h"
#include "trees/queries/points.h"
#include "trees/queries/rays.h"
#include "trees/queries/self_pairs.h"
#include "trees/queries/tree_pairs.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace boxwood {

/// Puts a layout and the traversals that are overloaded for it behind AnyLayout. The layout of a
/// split tree refuses what it would answer wrongly (std::invalid_argument): all but rays and
/// closest points.
template <Layout L> class LayoutModel final : public AnyLayout {
  public:
    explicit LayoutModel(L layout, bool is_split = false)
        : layout_(std::move(layout)), is_split_(is_split) {}

    std::size_t bytes() const override { return layout_.bytes(); }

    void self_pairs(const Executor& executor, PairSink& sink) const override {
        require_whole();
        boxwood::self_pairs(layout_, executor, sink);
    }
    Work self_pairs_counted(PairSink& sink) const override {
        require_whole();
        return boxwood::self_pairs_counted(layout_, sink);
    }
    void tree_pairs(const AnyLayout& other, const Executor& executor,
                    PairSink& sink) const override {
        boxwood::tree_pairs(layout_, same(other), executor, sink);
    }
    Work tree_pairs_counted(const AnyLayout& other, PairSink& sink) const override {
        return boxwood::tree_pairs_counted(layout_, same(other), sink);
    }
    TriangleBlocks triangles(const TriangleMesh& mesh, const Executor& executor) const override {
        return boxwood::triangles_of(layout_, mesh, executor);
    }
    void rays(std::span<const Ray<float>> rays, RayQuery query, std::string_view kernel,
              const TriangleBlocks& triangles, const Executor& executor,
              std::span<RayHit> hits) const override {
        boxwood::rays(layout_, rays, query, kernel, triangles, executor, hits);
    }
    Work rays_counted(std::span<const Ray<float>> rays, RayQuery query, std::string_view kernel,
                      const TriangleBlocks& triangles, std::span<RayHit> hits) const override {
        return boxwood::rays_counted(layout_, rays, query, kernel, triangles, hits);
    }

    SingleRayWalks single_ray_walks(std::string_view kernel) const override {
        return boxwood::single_ray_walks(layout_, kernel);
    }
    void rays_all(std::span<const Ray<float>> rays, std::string_view kernel,
                  const TriangleBlocks& triangles, const Executor& executor,
                  HitSink& sink) const override {
        boxwood::rays_all(layout_, rays, kernel, triangles, executor, sink);
    }
    void points(std::span<const Vec3<float>> points, const Executor& executor, PairSink& sink,
                Work* work) const override {
        require_whole();
        boxwood::points(layout_, points, executor, sink, work);
    }
    void regions(std::span<const Box> regions, const Executor& executor, PairSink& sink,
                 Work* work) const override {
        require_whole();
        boxwood::regions(layout_, regions, executor, sink, work);
    }
    void regions(std::span<const Sphere<float>> regions, const Executor& executor, PairSink& sink,
                 Work* work) const override {
        require_whole();
        boxwood::regions(layout_, regions, executor, sink, work);
    }
    void nearest(std::span<const Vec3<float>> points, std::size_t k, const Executor& executor,
                 std::span<Neighbour> out, Work* work) const override {
        require_whole();
        boxwood::nearest(layout_, points, k, executor, out, work);
    }
    void closest_points(std::span<const Vec3<float>> points, const TriangleMesh& mesh,
                        const Executor& executor, std::span<SurfacePoint> out,
                        Work* work) const override {
        boxwood::closest_points(layout_, points, mesh, executor, out, work);
    }

  private:
    void require_whole() const {
        if (is_split_)
            throw std::invalid_argument("a split tree is for rays and closest points alone; build "
                                        "one of the boxes for other queries");
    }
    const L& same(const AnyLayout& other) const {
        require_whole();
        if (const auto* model = dynamic_cast<const LayoutModel*>(&other)) {
            model->require_whole();
            return model->layout_;
        }
        throw std::invalid_argument("tree_pairs wants two trees of the layout '" +
                                    std::string(L::name) + "'");
    }

    L layout_;
    bool is_split_;
};

/// The registry row of a Layout type.
template <Layout L> LayoutEntry layout_entry() {
    LayoutEntry entry{L::name, L::summary,
                      [](const Tree& tree, const Executor& executor) -> std::unique_ptr<AnyLayout> {
                          return std::make_unique<LayoutModel<L>>(L(tree, executor), tree.is_split);
                      },
                      nullptr};
    if constexpr (requires(Boxes boxes, std::span<const std::uint32_t> order,
                           const Executor& executor) { L::of_order(boxes, order, executor); })
        entry.make_of_order = [](Boxes boxes, std::span<const std::uint32_t> order,
                                 const Executor& executor) -> std::unique_ptr<AnyLayout> {
            return std::make_unique<LayoutModel<L>>(L::of_order(boxes, order, executor));
        };
    if constexpr (requires(const Tree& tree, std::span<const Aabb<double>> boxes,
                           const Executor& executor) { L::of_doubles(tree, boxes, executor); }) {
        entry.make_of_doubles = [](const Tree& tree, std::span<const Aabb<double>> boxes,
                                   const Executor& executor) -> std::unique_ptr<AnyLayout> {
            return std::make_unique<LayoutModel<L>>(L::of_doubles(tree, boxes, executor));
        };
        entry.precision = "f64";
    }
    return entry;
}

} // namespace boxwood
