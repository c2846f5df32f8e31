#pragma once

#include "kernels/ray.h"
#include "kernels/ray_triangle/triangle_block.h"
#include "kernels/triangle.h"
#include "trees/executor.h"
#include "trees/pairs.h"
#include "trees/tree.h"
#include "trees/work.h"

#include <concepts>
#include <memory>
#include <span>
#include <string_view>

namespace boxwood {

/// A layout owns a copy of a tree in the form that some walk likes best. It is a function of the
/// tree alone, so that every builder serves every layout.
template <class L>
concept Layout = std::constructible_from<L, const Tree&> && requires(const L layout) {
    { layout.bytes() } -> std::convertible_to<std::size_t>;
    { L::name } -> std::convertible_to<std::string_view>;
    { L::summary } -> std::convertible_to<std::string_view>;
};

/// The triangles of a mesh where the ray walk of one layout looks for them.
using TriangleBlocks = Buffer<TriangleBlock<8>>;

enum class RayQuery : std::uint8_t {
    closest, ///< the hit with the least t, ties to the lowest triangle index
    any      ///< whether there is a hit at all: some hit, not always the same between layouts
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

    /// The triangles whose boxes this is the layout of, for `rays`.
    virtual TriangleBlocks triangles(const TriangleMesh& mesh) const = 0;

    /// hits[i] answers rays[i]; hits.size() == rays.size(). `kernel` is a word of `ray_kernels()`,
    /// `triangles` those of this very layout.
    virtual void rays(std::span<const Ray<float>> rays, RayQuery query, std::string_view kernel,
                      const TriangleBlocks& triangles, const Executor& executor,
                      std::span<RayHit> hits) const = 0;
    virtual Work rays_counted(std::span<const Ray<float>> rays, RayQuery query,
                              std::string_view kernel, const TriangleBlocks& triangles,
                              std::span<RayHit> hits) const = 0;
};

/// A catalogue row.
struct LayoutEntry {
    std::string_view name, summary;
    std::unique_ptr<AnyLayout> (*make)(const Tree&);
};

std::span<const LayoutEntry> layouts();

/// The layout by its catalogue word, or nullptr.
const LayoutEntry* find_layout(std::string_view name);

/// A row of the traversal catalogue.
struct TraversalEntry {
    std::string_view name, summary;
};
std::span<const TraversalEntry> traversals();

} // namespace boxwood
