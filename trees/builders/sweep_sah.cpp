// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/builders/sweep_sah.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/builders/detail/prim8-inl.h"
#include "trees/builders/detail/top_down_loop.h"
#include "trees/builders/sweep_sah.h"
#include "trees/optimizers/refit.h"

#include <array>
#include <limits>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

/// The first `left` items of the order along an axis against the others.
struct Split {
    float cost = std::numeric_limits<float>::infinity();
    std::uint32_t axis = 0, left = 0;
};

/// xy + z (x + y) of a box with its edges lengthened.
HWY_INLINE float half_area(F8 box, float edge) {
    alignas(32) float v[8];
    store_f8(box, v);
    const float x = v[0] + v[4] + edge, y = v[1] + v[5] + edge, z = v[2] + v[6] + edge;
    return x * y + z * (x + y);
}

/// The same items of a part stand at [first, first + count) of three orders, one along each axis.
class SweepSplitter {
  public:
    using Part = Subtree;

    SweepSplitter(Boxes boxes, const Executor& executor)
        : boxes_(boxes), executor_(executor), items_(boxes, executor),
          right_area_(3 * boxes.size()), goes_left_(boxes.size()), tree_(boxes.size()),
          max_depth_(2 * static_cast<std::uint32_t>(std::bit_width(boxes.size())) + 32) {}

    Tree run() {
        const auto n = static_cast<std::uint32_t>(boxes_.size());
        if (n == 0)
            return std::move(tree_);
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            order_[axis] = Buffer<Prim8>(n);
            other_[axis] = Buffer<Prim8>(n);
        }
        executor_.for_each(3, [&](std::size_t axis) {
            sort_by_centre(items_.prims.span(), static_cast<int>(axis), order_[axis].span());
        });
        build_by_splitter(*this, Part{0, 0, n, 0}, executor_, std::max(2048u, n / 16), max_depth_);
        if (items_.scale != 1)
            refit(tree_, boxes_);
        return std::move(tree_);
    }

    bool is_split(const Part& part) const { return part.count > 1; }

    Halves<Part> split(const Part& part) {
        const Split split =
            part.depth > max_depth_
                ? middle_split(part)
                : cheapest({best_along(part, 0), best_along(part, 1), best_along(part, 2)});
        mark(part, split);
        for (std::uint32_t axis = 0; axis < 3; ++axis)
            if (axis != split.axis)
                part_order(part, axis);
        return children_of(part, split.left);
    }

    /// The axes at the same time.
    void split_level(const std::vector<Part>& large, std::vector<Halves<Part>>& children) {
        std::vector<std::array<Split, 3>> along(large.size());
        executor_.for_each(3 * large.size(), [&](std::size_t i) {
            along[i / 3][i % 3] = best_along(large[i / 3], static_cast<std::uint32_t>(i % 3));
        });
        executor_.for_each(large.size(),
                           [&](std::size_t i) { mark(large[i], cheapest(along[i])); });
        executor_.for_each(3 * large.size(), [&](std::size_t i) {
            const auto axis = static_cast<std::uint32_t>(i % 3);
            if (axis != cheapest(along[i / 3]).axis)
                part_order(large[i / 3], axis);
        });
        for (std::size_t i = 0; i < large.size(); ++i)
            children[i] = children_of(large[i], cheapest(along[i]).left);
    }

    void finish(const Part& leaf) {
        const Prim8& p = order_[0][leaf.first];
        write_node(load_f8(p.v), leaf.first, 1, tree_.nodes[leaf.node]);
        tree_.order[leaf.first] = p.item();
    }
    void build(const Part& part) { build_below(*this, part); }

  private:
    /// Tries every split along an axis, and writes the node if it is the first axis. Of equal costs
    /// the more even split is cheaper by a little, so that equal boxes make no chain.
    Split best_along(const Part& r, std::uint32_t axis) {
        const Prim8* items = order_[axis].data() + r.first;
        float* right_area = right_area_.data() + axis * boxes_.size() + r.first;
        const F8 lowest = load_f8(items[0].v), highest = load_f8(items[r.count - 1].v);
        alignas(32) float low[8], high[8];
        store_f8(doubled_centre(lowest), low);
        store_f8(doubled_centre(highest), high);
        F8 side = highest;
        const float edge = edge_of(r);
        for (std::uint32_t i = r.count; --i > 0;) {
            side = max_f8(side, load_f8(items[i].v));
            right_area[i] = half_area(side, edge);
        }
        const F8 all = max_f8(side, lowest);
        if (axis == 0)
            write_node(all, r.first, r.count, tree_.nodes[r.node]);
        const float uneven = half_area(all, edge) * 0x1p-20f;
        side = lowest;
        Split best;
        for (std::uint32_t i = 1; i < r.count; ++i) {
            const auto left = static_cast<float>(i), right = static_cast<float>(r.count - i);
            const float cost = half_area(side, edge) * left + right_area[i] * right +
                               uneven * std::abs(left - right);
            if (cost < best.cost)
                best = {cost, axis, i};
            side = max_f8(side, load_f8(items[i].v));
        }
        return best;
    }

    float spread(const Part& r, std::uint32_t axis) const {
        const Prim8* items = order_[axis].data() + r.first;
        return items[r.count - 1].doubled_centre(static_cast<int>(axis)) -
               items[0].doubled_centre(static_cast<int>(axis));
    }
    /// Next to nothing by the size of the node, so that boxes along a line have areas too.
    float edge_of(const Part& r) const {
        return std::max({spread(r, 0), spread(r, 1), spread(r, 2)}) * 0x1p-20f;
    }

    Split middle_split(const Part& r) {
        write_node(bounds_of_boxes(order_[0].data() + r.first, r.count), r.first, r.count,
                   tree_.nodes[r.node]);
        Split middle{0, 0, r.count / 2};
        for (std::uint32_t axis = 1; axis < 3; ++axis)
            if (spread(r, axis) > spread(r, middle.axis))
                middle.axis = axis;
        return middle;
    }

    static Split cheapest(const std::array<Split, 3>& along) {
        Split best = along[0];
        for (const Split& split : along)
            if (split.cost < best.cost)
                best = split;
        return best;
    }

    void mark(const Part& r, Split split) {
        const Prim8* items = order_[split.axis].data() + r.first;
        for (std::uint32_t i = 0; i < r.count; ++i)
            goes_left_[items[i].item()] = i < split.left;
    }

    /// Partitions the order along an axis, both sides in their old order and without a branch.
    void part_order(const Part& r, std::uint32_t axis) {
        Prim8* items = order_[axis].data() + r.first;
        Prim8* aside = other_[axis].data() + r.first;
        std::size_t n_left = 0, n_right = 0;
        for (std::uint32_t i = 0; i < r.count; ++i) {
            const F8 box = load_f8(items[i].v);
            const std::size_t left = goes_left_[items[i].item()];
            store_f8(box, items[n_left].v);
            store_f8(box, aside[n_right].v);
            n_left += left;
            n_right += 1 - left;
        }
        std::copy_n(aside, n_right, items + n_left);
    }

    Boxes boxes_;
    const Executor& executor_;
    Prims8 items_;
    std::array<Buffer<Prim8>, 3> order_, other_;
    Buffer<float> right_area_;       ///< of each axis
    Buffer<std::uint8_t> goes_left_; ///< item -> 1 or 0
    Tree tree_;
    const std::uint32_t max_depth_;
};

Tree build_by_sweep(Boxes boxes, const Executor& executor) {
    return SweepSplitter(boxes, executor).run();
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(build_by_sweep);
}

namespace boxwood {
using namespace detail;

Tree SweepSahBuilder::build(Boxes boxes, const Executor& executor) const {
    return HWY_DYNAMIC_DISPATCH(build_by_sweep)(boxes, executor);
}

BuilderEntry sweep_sah_builder() { return builder_entry<SweepSahBuilder>(); }

} // namespace boxwood
#endif
