#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/ray_triangle/triangle_block.h"
#include "kernels/primitives/sphere.h"
#include "kernels/primitives/triangle.h"
#include "trees/builder.h"
#include "trees/executor.h"
#include "trees/queries/pairs.h"
#include "trees/tree.h"
#include "trees/inspect/work.h"

#include <compare>
#include <concepts>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string_view>

namespace boxwood {

/// A layout owns a copy of a tree in the form that some walk likes best. It is a function of the
/// tree alone, the same on every executor, so that every builder serves every layout. One that
/// needs no more than an order of the items is also made from that: L::of_order(boxes, order,
/// executor).
template <class L>
concept Layout = std::constructible_from<L, const Tree&, const Executor&> &&
    requires(const L layout) {
    { layout.bytes() } -> std::convertible_to<std::size_t>;
    { L::name } -> std::convertible_to<std::string_view>;
    { L::summary } -> std::convertible_to<std::string_view>;
};

/// What the ray walk of one layout reads: the triangles of a mesh in blocks of four or eight, and
/// above them a copy of the inner nodes that knows where those are (traversals/ray_tree.h).
struct TriangleBlocks {
    Buffer<std::byte> nodes, blocks;
    std::uint32_t root = 0;
    Box bounds; ///< of all triangles

    std::size_t bytes() const { return nodes.bytes() + blocks.bytes(); }
};

enum class RayQuery : std::uint8_t {
    closest, ///< the hit with the least t, ties to the lowest triangle index
    any      ///< whether there is a hit at all: some hit, not always the same between layouts
};

struct SingleRayTree;

/// How one ray is walked through a layout by a kernel, on this machine (traversals/single_rays.h).
struct SingleRayWalks {
    RayHit (*closest)(const SingleRayTree& tree, const Ray<float>& ray) = nullptr;
    bool (*any)(const SingleRayTree& tree, const Ray<float>& ray) = nullptr;
};

/// An item near a point, and the square of the distance from the point to its box (0 inside).
struct Neighbour {
    std::uint32_t item = none;
    double squared_distance = std::numeric_limits<double>::infinity();

    static constexpr std::uint32_t none = ~std::uint32_t{0};
    constexpr auto operator<=>(const Neighbour&) const = default;
};

/// The point of a mesh that is nearest to a query point, on the lowest of the triangles that have
/// it; `triangle` is Neighbour::none if the mesh is empty.
struct SurfacePoint {
    Vec3<float> point{};
    std::uint32_t triangle = Neighbour::none;
    double squared_distance = std::numeric_limits<double>::infinity();
};

/// Where all hits of a ray go: by chunks as PairSink, a ray's hits in one batch, by t and then by
/// triangle; a ray without hits is passed over.
class HitSink {
  public:
    virtual ~HitSink() = default;
    virtual void begin(std::size_t chunks, bool in_order) = 0;
    virtual bool take(std::size_t chunk, std::uint32_t ray, std::span<const RayHit> hits) = 0;
    virtual void end() = 0;
};

/// A layout with its queries behind virtual calls: one per query, none inside.
class AnyLayout {
  public:
    virtual ~AnyLayout() = default;
    virtual std::size_t bytes() const = 0;

    /// Every unordered pair of overlapping items once, lower item first.
    virtual void self_pairs(const Executor& executor, PairSink& sink) const = 0;
    virtual Work self_pairs_counted(PairSink& sink) const = 0;

    /// Every overlapping (item here, item of `other`) once. Both must be of the same layout, else
    /// std::invalid_argument.
    virtual void tree_pairs(const AnyLayout& other, const Executor& executor,
                            PairSink& sink) const = 0;
    virtual Work tree_pairs_counted(const AnyLayout& other, PairSink& sink) const = 0;

    /// The triangles whose boxes this is the layout of, for `rays`: the same on every executor.
    virtual TriangleBlocks triangles(const TriangleMesh& mesh,
                                     const Executor& executor = serial()) const = 0;

    /// hits[i] answers rays[i]; hits.size() == rays.size(). `kernel` is a word of `ray_kernels()`,
    /// `triangles` those of this very layout.
    virtual void rays(std::span<const Ray<float>> rays, RayQuery query, std::string_view kernel,
                      const TriangleBlocks& triangles, const Executor& executor,
                      std::span<RayHit> hits) const = 0;
    virtual Work rays_counted(std::span<const Ray<float>> rays, RayQuery query,
                              std::string_view kernel, const TriangleBlocks& triangles,
                              std::span<RayHit> hits) const = 0;
    /// For SingleRays; null where a batch of one has to do.
    virtual SingleRayWalks single_ray_walks(std::string_view kernel) const = 0;
    /// Every hit of every ray with t_min <= t <= t_max, each triangle once.
    virtual void rays_all(std::span<const Ray<float>> rays, std::string_view kernel,
                          const TriangleBlocks& triangles, const Executor& executor,
                          HitSink& sink) const = 0;

    // Queries of many points, boxes or spheres at a time. The sink's pairs are (index of the query,
    // item), those of one query by item. `work`, if given, is added to, and wants the executor
    // serial().

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
    std::unique_ptr<AnyLayout> (*make)(const Tree&, const Executor&);
    /// From an order of the items alone; null if the layout needs the tree.
    std::unique_ptr<AnyLayout> (*make_of_order)(Boxes, std::span<const std::uint32_t> order,
                                                const Executor&);
    /// Around the exact boxes of the items, which the tree's float boxes contain: its queries then
    /// answer for these. Null unless `precision` is f64. Throws InvalidBox for the first bad one.
    std::unique_ptr<AnyLayout> (*make_of_doubles)(const Tree&, std::span<const Aabb<double>> boxes,
                                                  const Executor&) = nullptr;
    std::string_view precision = "f32"; ///< of the boxes held; f64 made from a tree: its floats
};

std::span<const LayoutEntry> layouts();

/// The layout by its registry word, or nullptr.
const LayoutEntry* find_layout(std::string_view name);

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
