#pragma once

#include "kernels/primitives/sphere.h"
#include "trees/layout.h"
#include "trees/queries/points.h"
#include "trees/queries/regions.h"
#include "trees/queries/self_pairs.h"
#include "trees/queries/single_rays.h"
#include "trees/queries/tree_pairs.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace boxwood {

/// Whether the functions of a query are overloaded for L, in this namespace or beside L.
template <class L> constexpr bool answers_query(Query query) {
    using Points = std::span<const Vec3<float>>;
    using Rays = std::span<const Ray<float>>;
    switch (query) {
    case Query::self_pairs:
        return requires(const L& l, const Executor& e, PairSink& s, Work* w) {
            self_pairs(l, e, s, w);
        };
    case Query::tree_pairs:
        return requires(const L& l, const Executor& e, PairSink& s, Work* w) {
            tree_pairs(l, l, e, s, w);
        };
    case Query::rays:
        return requires(const L& l, const Executor& e, const TriangleMesh& mesh, Rays r,
                        const TriangleBlocks& t, HitSink& s, std::span<RayHit> hits, Work* w) {
            triangles_of(l, mesh, e);
            rays(l, r, RayQuery::any, std::string_view(), t, e, hits, w);
            rays_all(l, r, std::string_view(), t, e, s);
        };
    case Query::points:
        return requires(const L& l, const Executor& e, Points p, PairSink& s, Work* w) {
            points(l, p, e, s, w);
        };
    case Query::regions:
        return requires(const L& l, const Executor& e, std::span<const Box> boxes,
                        std::span<const Sphere<float>> balls, PairSink& s, Work* w) {
            regions(l, boxes, e, s, w);
            regions(l, balls, e, s, w);
        };
    case Query::nearest:
        return requires(const L& l, const Executor& e, Points p, std::span<Neighbour> out,
                        Work* w) {
            nearest(l, p, std::size_t{1}, e, out, w);
        };
    case Query::closest_points:
        return requires(const L& l, const Executor& e, Points p, const TriangleMesh& mesh,
                        std::span<SurfacePoint> out, Work* w) {
            closest_points(l, p, mesh, e, out, w);
        };
    }
    return false;
}

template <class L> std::vector<Query> answered_queries() {
    using enum Query;
    std::vector<Query> answered;
    for (const Query query :
         {self_pairs, tree_pairs, rays, points, regions, nearest, closest_points})
        if (answers_query<L>(query))
            answered.push_back(query);
    return answered;
}

/// Puts a layout, or what else answers such queries, behind AnyLayout, with the queries that are
/// overloaded for it. The layout of a split tree refuses what it would answer wrongly: all but rays
/// and closest points. Held: L, or a reference to one that is kept elsewhere.
template <class L, class Held = L> class LayoutModel final : public AnyLayout {
  public:
    explicit LayoutModel(Held layout, bool is_split = false)
        : held_(std::move(layout)), is_split_(is_split) {}

    std::size_t bytes() const override { return layout().bytes(); }
    bool answers(Query query) const override { return answers_query<L>(query) && suits(query); }

    void self_pairs(const Executor& executor, PairSink& sink, Work* work) const override {
        require(Query::self_pairs);
        if constexpr (answers_query<L>(Query::self_pairs)) {
            using boxwood::self_pairs;
            self_pairs(layout(), executor, sink, work);
        }
    }
    void tree_pairs(const AnyLayout& other, const Executor& executor, PairSink& sink,
                    Work* work) const override {
        require(Query::tree_pairs);
        if constexpr (answers_query<L>(Query::tree_pairs)) {
            using boxwood::tree_pairs;
            tree_pairs(layout(), same(other), executor, sink, work);
        }
    }
    TriangleBlocks triangles(const TriangleMesh& mesh, const Executor& executor) const override {
        require(Query::rays);
        if constexpr (answers_query<L>(Query::rays))
            return triangles_of(layout(), mesh, executor);
        else
            return {};
    }
    void rays(std::span<const Ray<float>> batch, RayQuery query, std::string_view kernel,
              const TriangleBlocks& triangles, const Executor& executor, std::span<RayHit> hits,
              Work* work) const override {
        require(Query::rays);
        if constexpr (answers_query<L>(Query::rays)) {
            using boxwood::rays;
            rays(layout(), batch, query, kernel, triangles, executor, hits, work);
        }
    }
    SingleRayFunctions single_ray_functions(std::string_view kernel) const override {
        require(Query::rays);
        using boxwood::single_ray_functions;
        if constexpr (requires(const L& l) { single_ray_functions(l, kernel); })
            return single_ray_functions(layout(), kernel);
        else
            return {};
    }
    void rays_all(std::span<const Ray<float>> batch, std::string_view kernel,
                  const TriangleBlocks& triangles, const Executor& executor,
                  HitSink& sink) const override {
        require(Query::rays);
        if constexpr (answers_query<L>(Query::rays)) {
            using boxwood::rays_all;
            rays_all(layout(), batch, kernel, triangles, executor, sink);
        }
    }
    void points(std::span<const Vec3<float>> at, const Executor& executor, PairSink& sink,
                Work* work) const override {
        require(Query::points);
        if constexpr (answers_query<L>(Query::points)) {
            using boxwood::points;
            points(layout(), at, executor, sink, work);
        }
    }
    void regions(std::span<const Box> boxes, const Executor& executor, PairSink& sink,
                 Work* work) const override {
        answer_regions(boxes, executor, sink, work);
    }
    void regions(std::span<const Sphere<float>> balls, const Executor& executor, PairSink& sink,
                 Work* work) const override {
        answer_regions(balls, executor, sink, work);
    }
    void nearest(std::span<const Vec3<float>> at, std::size_t k, const Executor& executor,
                 std::span<Neighbour> out, Work* work) const override {
        require(Query::nearest);
        if constexpr (answers_query<L>(Query::nearest)) {
            using boxwood::nearest;
            nearest(layout(), at, k, executor, out, work);
        }
    }
    void closest_points(std::span<const Vec3<float>> at, const TriangleMesh& mesh,
                        const Executor& executor, std::span<SurfacePoint> out,
                        Work* work) const override {
        require(Query::closest_points);
        if constexpr (answers_query<L>(Query::closest_points)) {
            using boxwood::closest_points;
            closest_points(layout(), at, mesh, executor, out, work);
        }
    }

  private:
    template <class Region>
    void answer_regions(std::span<const Region> of, const Executor& executor, PairSink& sink,
                        Work* work) const {
        require(Query::regions);
        if constexpr (answers_query<L>(Query::regions)) {
            using boxwood::regions;
            regions(layout(), of, executor, sink, work);
        }
    }

    bool suits(Query query) const {
        return !is_split_ || query == Query::rays || query == Query::closest_points;
    }
    void require(Query query) const {
        if (!answers_query<L>(query))
            throw std::invalid_argument("the layout '" + std::string(L::name) +
                                        "' does not answer " + std::string(to_string(query)));
        if (!suits(query))
            throw std::invalid_argument("a split tree is for rays and closest points alone; build "
                                        "one of the boxes for other queries");
    }
    const L& layout() const { return held_; }
    const L& same(const AnyLayout& other) const {
        const auto* model = dynamic_cast<const LayoutModel*>(&other);
        if (!model)
            throw std::invalid_argument("pairs of two trees: both must have one layout, and the "
                                        "first has '" +
                                        std::string(L::name) + "'; build the other in it, too");
        model->require(Query::tree_pairs);
        return model->layout();
    }

    Held held_;
    bool is_split_;
};

/// The registry row of a Layout type. The functions that answer its queries must be declared
/// before.
template <Layout L> LayoutEntry layout_entry() {
    LayoutEntry entry{L::name, L::summary, answered_queries<L>(),
                      [](const Tree& tree, const Executor& executor) -> std::unique_ptr<AnyLayout> {
                          return std::make_unique<LayoutModel<L>>(L(tree, executor), tree.is_split);
                      }};
    if constexpr (OrderLayout<L>)
        entry.make_of_order = [](Boxes boxes, std::span<const std::uint32_t> order,
                                 const Executor& executor) -> std::unique_ptr<AnyLayout> {
            return std::make_unique<LayoutModel<L>>(L::of_order(boxes, order, executor));
        };
    if constexpr (DoubleLayout<L>) {
        entry.make_of_doubles = [](const Tree& tree, std::span<const Aabb<double>> boxes,
                                   const Executor& executor) -> std::unique_ptr<AnyLayout> {
            return std::make_unique<LayoutModel<L>>(L::of_doubles(tree, boxes, executor));
        };
        entry.precision = "f64";
    }
    return entry;
}

} // namespace boxwood
