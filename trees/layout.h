#pragma once

#include "kernels/primitives/sphere.h"
#include "trees/builder.h"
#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/layouts/layouts.h"
#include "trees/queries/nearest.h"
#include "trees/queries/rays.h"
#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <concepts>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace boxwood {

struct SingleRayFunctions;

/// A layout owns a copy of a tree in the form that some traversal likes best. It is a function of
/// the tree alone, the same on every executor, so that every builder serves every layout. What it
/// answers are the functions of queries/ that are overloaded for it: any subset of them.
template <class L>
concept Layout = std::constructible_from<L, const Tree&, const Executor&> && std::movable<L> &&
    requires(const L layout) {
    { layout.bytes() } -> std::convertible_to<std::size_t>;
    { L::name } -> std::convertible_to<std::string_view>;
    { L::summary } -> std::convertible_to<std::string_view>;
};

/// A layout that is also made of an order of the items alone, without a tree.
template <class L>
concept OrderLayout = Layout<L> &&
    requires(Boxes boxes, std::span<const std::uint32_t> order, const Executor& executor) {
    { L::of_order(boxes, order, executor) } -> std::same_as<L>;
};

/// A layout of doubles, also made around the exact boxes of a tree's items.
template <class L>
concept DoubleLayout = Layout<L> &&
    requires(const Tree& tree, std::span<const Aabb<double>> boxes, const Executor& executor) {
    { L::of_doubles(tree, boxes, executor) } -> std::same_as<L>;
};

/// What a layout may answer. `rays` stands for closest, any and all hits.
enum class Query : std::uint8_t {
    self_pairs,
    tree_pairs,
    rays,
    points,
    regions,
    nearest,
    closest_points
};
std::string_view to_string(Query query);

/// A layout with its queries behind virtual calls: one per query, none inside. A query that the
/// layout does not answer throws std::invalid_argument, which names both. `work`, if given, is
/// added to, and the executor must be serial().
class AnyLayout {
  public:
    virtual ~AnyLayout() = default;
    virtual std::size_t bytes() const = 0;
    virtual bool answers(Query query) const = 0;

    /// Every unordered pair of overlapping items once, lower item first.
    virtual void self_pairs(const Executor& executor, PairSink& sink,
                            Work* work = nullptr) const = 0;
    Work self_pairs_counted(PairSink& sink) const {
        Work work;
        self_pairs(serial(), sink, &work);
        return work;
    }

    /// Every overlapping (item here, item of `other`) once. Both must be of the same layout, else
    /// std::invalid_argument.
    virtual void tree_pairs(const AnyLayout& other, const Executor& executor, PairSink& sink,
                            Work* work = nullptr) const = 0;
    Work tree_pairs_counted(const AnyLayout& other, PairSink& sink) const {
        Work work;
        tree_pairs(other, serial(), sink, &work);
        return work;
    }

    /// The triangles whose boxes this is the layout of, for `rays`: the same on every executor.
    virtual TriangleBlocks triangles(const TriangleMesh& mesh,
                                     const Executor& executor = serial()) const = 0;

    /// hits[i] answers rays[i]; hits.size() == rays.size(). `kernel` is a name of `ray_kernels()`,
    /// `triangles` those of this very layout.
    virtual void rays(std::span<const Ray<float>> rays, RayQuery query, std::string_view kernel,
                      const TriangleBlocks& triangles, const Executor& executor,
                      std::span<RayHit> hits, Work* work = nullptr) const = 0;
    Work rays_counted(std::span<const Ray<float>> batch, RayQuery query, std::string_view kernel,
                      const TriangleBlocks& triangles, std::span<RayHit> hits) const {
        Work work;
        rays(batch, query, kernel, triangles, serial(), hits, &work);
        return work;
    }
    /// For SingleRays; null where a batch of one has to do.
    virtual SingleRayFunctions single_ray_functions(std::string_view kernel) const = 0;
    /// Every hit of every ray with t_min <= t <= t_max, each triangle once.
    virtual void rays_all(std::span<const Ray<float>> rays, std::string_view kernel,
                          const TriangleBlocks& triangles, const Executor& executor,
                          HitSink& sink) const = 0;

    // Queries of many points, boxes or spheres at a time. The sink's pairs are (index of the query,
    // item), those of one query by item.

    /// Every item whose box contains the point; shares a point with the box; with the sphere.
    virtual void points(std::span<const Vec3<float>> points, const Executor& executor,
                        PairSink& sink, Work* work = nullptr) const = 0;
    virtual void regions(std::span<const Box> regions, const Executor& executor, PairSink& sink,
                         Work* work = nullptr) const = 0;
    virtual void regions(std::span<const Sphere<float>> regions, const Executor& executor,
                         PairSink& sink, Work* work = nullptr) const = 0;

    /// The k items nearest to each point, by distance and then by item: out[k i ...] answers
    /// points[i], filled up with no item if there are fewer. out.size() == k * points.size().
    virtual void nearest(std::span<const Vec3<float>> points, std::size_t k,
                         const Executor& executor, std::span<Neighbour> out,
                         Work* work = nullptr) const = 0;

    /// The nearest point of the mesh whose triangles' boxes this is the layout of, computed in
    /// doubles and rounded.
    virtual void closest_points(std::span<const Vec3<float>> points, const TriangleMesh& mesh,
                                const Executor& executor, std::span<SurfacePoint> out,
                                Work* work = nullptr) const = 0;
};

/// A registry row.
struct LayoutEntry {
    std::string_view name, summary;
    std::vector<Query> queries; ///< those that it answers
    std::unique_ptr<AnyLayout> (*make)(const Tree&, const Executor&);
    /// From an order of the items alone; null if the layout needs the tree.
    std::unique_ptr<AnyLayout> (*make_of_order)(Boxes, std::span<const std::uint32_t> order,
                                                const Executor&) = nullptr;
    /// Around the exact boxes of the items, which the tree's float boxes contain: its queries then
    /// answer for these. Null unless `precision` is f64. Throws InvalidBox for the first bad one.
    std::unique_ptr<AnyLayout> (*make_of_doubles)(const Tree&, std::span<const Aabb<double>> boxes,
                                                  const Executor&) = nullptr;
    std::string_view precision = "f32"; ///< of the boxes held; f64 made from a tree: its floats

    bool answers(Query query) const;
};

std::span<const LayoutEntry> layouts();

/// The layout by its registered name. Throws std::invalid_argument for an unknown one, with a
/// suggestion.
const LayoutEntry& find_layout(std::string_view name);
inline const LayoutEntry& layout_entry_of(LayoutName name) {
    return layouts()[static_cast<std::size_t>(name)];
}

/// The layout of the boxes by this builder: by its order alone if both sides know how; else by its
/// tree, which is kept in `tree` (else that is left empty).
std::unique_ptr<AnyLayout> make_layout(const LayoutEntry& layout, const BuildFunction& builder,
                                       Boxes boxes, const Executor& executor, Tree& tree);

/// A row of the traversal registry.
struct TraversalEntry {
    std::string_view name, summary;
};
std::span<const TraversalEntry> traversals();

} // namespace boxwood
