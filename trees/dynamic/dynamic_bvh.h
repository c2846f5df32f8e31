#pragma once

#include "kernels/primitives/ray.h"
#include "trees/dynamic/dynamic_tree.h"
#include "trees/function_ref.h"
#include "trees/queries/box_queries.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace boxwood {

struct DynamicBvhOptions {
    unsigned threads = 1;                               ///< of queries
    std::shared_ptr<const Executor> executor = nullptr; ///< one of your own, instead of threads
};

/// Boxes that come, go and move one at a time, in O(log n) each, and are queried in between: a
/// DynamicTree, which answers as it stands. Items are numbered by the caller, best without large
/// gaps. Errors: DynamicTree. Queries and threads: BoxQueries.
class DynamicBvh : public BoxQueries {
  public:
    explicit DynamicBvh(const DynamicBvhOptions& options = {});
    /// With box i as item i.
    explicit DynamicBvh(Boxes boxes, const DynamicBvhOptions& options = {});
    DynamicBvh(DynamicBvh&&) noexcept = default;
    DynamicBvh& operator=(DynamicBvh&&) noexcept = default;

    void insert(std::uint32_t item, const Box& box) { tree_->insert(item, box); }
    void remove(std::uint32_t item) { tree_->remove(item); }
    void move(std::uint32_t item, const Box& box) { tree_->move(item, box); }
    void clear() { tree_->clear(); }
    /// Room for items 0 .. n - 1.
    void reserve(std::size_t n) { tree_->reserve(n); }

    std::size_t size() const { return tree_->size(); }
    bool empty() const { return tree_->empty(); }
    bool contains(std::uint32_t item) const { return tree_->contains(item); }
    const Box& box(std::uint32_t item) const { return tree_->box(item); }
    std::size_t bytes() const { return tree_->bytes(); }
    /// The part beneath.
    const DynamicTree& tree() const { return *tree_; }

    /// The items whose boxes a ray meets, ascending: all of those, and perhaps some that it misses
    /// by a rounding (RaySlabs, kernels/ray_box/slabs.h). None of a ray that is not finite.
    std::vector<std::uint32_t> meeting(const Ray<float>& ray) const;
    /// The same for who knows what is in the boxes: visit(item, ray) returns the t at which the ray
    /// ends from now on, ray.t_max if the item leaves it as it is. Nearer boxes come first,
    /// roughly.
    void meeting(const Ray<float>& ray,
                 FunctionRef<float(std::uint32_t, const Ray<float>&)> visit) const;

  private:
    std::unique_ptr<DynamicTree> tree_; ///< at one place, as layout_ refers to it
};

} // namespace boxwood
