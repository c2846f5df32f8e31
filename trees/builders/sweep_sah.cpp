// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/builders/sweep_sah.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/builders/detail/prim8-inl.h"
#include "trees/builders/sweep_sah.h"
#include "trees/optimizers/refit.h"

#include <array>
#include <limits>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

/// A subtree to build: the same items stand at [first, first + count) of all
/// three orders.
struct SweepRange {
    std::uint32_t node, first, count, depth;
};

/// The first `left` items of the order along an axis against the others.
struct Split {
    float cost = std::numeric_limits<float>::infinity();
    std::uint32_t axis = 0, left = 0;
};

/// xy + z (x + y) of a box with its edges lengthened.
HWY_INLINE float HalfArea(F8 box, float edge) {
    alignas(32) float v[8];
    StoreF8(box, v);
    const float x = v[0] + v[4] + edge, y = v[1] + v[5] + edge, z = v[2] + v[6] + edge;
    return x * y + z * (x + y);
}

class SweepBuild {
  public:
    SweepBuild(Boxes boxes, const Executor& executor)
        : boxes_(boxes), executor_(executor), items_(boxes, executor),
          right_area_(3 * boxes.size()), goes_left_(boxes.size()), tree_(boxes.size()),
          depth_limit_(2 * static_cast<std::uint32_t>(std::bit_width(boxes.size())) + 32) {}

    Tree Run() {
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
        const std::vector<SweepRange> subtrees = SplitTop({0, 0, n, 0});
        executor_.for_each(subtrees.size(), [&](std::size_t i) { BuildSubtree(subtrees[i]); });
        if (items_.scale != 1)
            refit(tree_, boxes_);
        return std::move(tree_);
    }

  private:
    using Halves = std::pair<SweepRange, SweepRange>;

    static Halves Children(const SweepRange& r, std::uint32_t left) {
        return {{r.node + 1, r.first, left, r.depth + 1},
                {r.node + 2 * left, r.first + left, r.count - left, r.depth + 1}};
    }

    /// Tries every split along an axis, and writes the node's box if it is the
    /// first axis. Of equal costs the more even split is cheaper by a little, so
    /// that equal boxes make no chain.
    Split BestAlong(const SweepRange& r, std::uint32_t axis) {
        const Prim8* items = order_[axis].data() + r.first;
        float* right_area = right_area_.data() + axis * boxes_.size() + r.first;
        const F8 lowest = LoadF8(items[0].v), highest = LoadF8(items[r.count - 1].v);
        alignas(32) float low[8], high[8];
        StoreF8(DoubledCentre(lowest), low);
        StoreF8(DoubledCentre(highest), high);
        F8 side = highest;
        const float edge = Edge(r);
        for (std::uint32_t i = r.count; --i > 0;) {
            side = MaxF8(side, LoadF8(items[i].v));
            right_area[i] = HalfArea(side, edge);
        }
        const F8 all = MaxF8(side, lowest);
        if (axis == 0)
            WriteNode(all, r.first, r.count, tree_.nodes[r.node]);
        const float uneven = HalfArea(all, edge) * 0x1p-20f;
        side = lowest;
        Split best;
        for (std::uint32_t i = 1; i < r.count; ++i) {
            const auto left = static_cast<float>(i), right = static_cast<float>(r.count - i);
            const float cost = HalfArea(side, edge) * left + right_area[i] * right +
                               uneven * std::abs(left - right);
            if (cost < best.cost)
                best = {cost, axis, i};
            side = MaxF8(side, LoadF8(items[i].v));
        }
        return best;
    }

    float Spread(const SweepRange& r, std::uint32_t axis) const {
        const Prim8* items = order_[axis].data() + r.first;
        return items[r.count - 1].doubled_centre(static_cast<int>(axis)) -
               items[0].doubled_centre(static_cast<int>(axis));
    }
    /// Next to nothing by the size of the node, so that boxes along a line have
    /// areas too.
    float Edge(const SweepRange& r) const {
        return std::max({Spread(r, 0), Spread(r, 1), Spread(r, 2)}) * 0x1p-20f;
    }

    Split Middle(const SweepRange& r) {
        WriteNode(BoundsOfBoxes(order_[0].data() + r.first, r.count), r.first, r.count,
                  tree_.nodes[r.node]);
        Split middle{0, 0, r.count / 2};
        for (std::uint32_t axis = 1; axis < 3; ++axis)
            if (Spread(r, axis) > Spread(r, middle.axis))
                middle.axis = axis;
        return middle;
    }

    static Split Cheapest(const std::array<Split, 3>& along) {
        Split best = along[0];
        for (const Split& split : along)
            if (split.cost < best.cost)
                best = split;
        return best;
    }

    void Mark(const SweepRange& r, Split split) {
        const Prim8* items = order_[split.axis].data() + r.first;
        for (std::uint32_t i = 0; i < r.count; ++i)
            goes_left_[items[i].item()] = i < split.left;
    }

    /// Parts the order along an axis, both sides in their old order and without a
    /// branch.
    void PartOrder(const SweepRange& r, std::uint32_t axis) {
        Prim8* items = order_[axis].data() + r.first;
        Prim8* aside = other_[axis].data() + r.first;
        std::size_t n_left = 0, n_right = 0;
        for (std::uint32_t i = 0; i < r.count; ++i) {
            const F8 box = LoadF8(items[i].v);
            const std::size_t left = goes_left_[items[i].item()];
            StoreF8(box, items[n_left].v);
            StoreF8(box, aside[n_right].v);
            n_left += left;
            n_right += 1 - left;
        }
        std::copy_n(aside, n_right, items + n_left);
    }

    void WriteLeaf(const SweepRange& r) {
        const Prim8& p = order_[0][r.first];
        WriteNode(LoadF8(p.v), r.first, 1, tree_.nodes[r.node]);
        tree_.order[r.first] = p.item();
    }

    void BuildSubtree(const SweepRange& root) {
        // The smaller half is taken at once and the larger waits, so 32 entries
        // always suffice.
        SweepRange waiting[32];
        std::size_t n_waiting = 0;
        for (SweepRange r = root;;) {
            if (r.count > 1) {
                const Split split =
                    r.depth > depth_limit_
                        ? Middle(r)
                        : Cheapest({BestAlong(r, 0), BestAlong(r, 1), BestAlong(r, 2)});
                Mark(r, split);
                for (std::uint32_t axis = 0; axis < 3; ++axis)
                    if (axis != split.axis)
                        PartOrder(r, axis);
                auto [a, b] = Children(r, split.left);
                if (a.count > b.count)
                    std::swap(a, b);
                waiting[n_waiting++] = b;
                r = a;
                continue;
            }
            WriteLeaf(r);
            if (n_waiting == 0)
                break;
            r = waiting[--n_waiting];
        }
    }

    /// Splits the top of the tree a level at a time, the axes at the same time,
    /// until no part is much of the whole.
    std::vector<SweepRange> SplitTop(const SweepRange& root) {
        const std::uint32_t enough = std::max(std::uint32_t{2048}, root.count / 16);
        std::vector<SweepRange> frontier{root}, done;
        while (!frontier.empty()) {
            std::vector<SweepRange> large;
            for (const SweepRange& r : frontier)
                (r.count > enough && r.depth <= depth_limit_ ? large : done).push_back(r);
            std::vector<std::array<Split, 3>> along(large.size());
            executor_.for_each(3 * large.size(), [&](std::size_t i) {
                along[i / 3][i % 3] = BestAlong(large[i / 3], static_cast<std::uint32_t>(i % 3));
            });
            executor_.for_each(large.size(),
                               [&](std::size_t i) { Mark(large[i], Cheapest(along[i])); });
            executor_.for_each(3 * large.size(), [&](std::size_t i) {
                const auto axis = static_cast<std::uint32_t>(i % 3);
                if (axis != Cheapest(along[i / 3]).axis)
                    PartOrder(large[i / 3], axis);
            });
            frontier.clear();
            for (std::size_t i = 0; i < large.size(); ++i) {
                const Halves halves = Children(large[i], Cheapest(along[i]).left);
                frontier.push_back(halves.first);
                frontier.push_back(halves.second);
            }
        }
        std::ranges::sort(done, std::ranges::greater{}, &SweepRange::count);
        return done;
    }

    Boxes boxes_;
    const Executor& executor_;
    Prims8 items_;
    std::array<Buffer<Prim8>, 3> order_, other_;
    Buffer<float> right_area_;       ///< of each axis
    Buffer<std::uint8_t> goes_left_; ///< item -> 1 or 0
    Tree tree_;
    const std::uint32_t depth_limit_;
};

Tree BuildBySweep(Boxes boxes, const Executor& executor) {
    return SweepBuild(boxes, executor).Run();
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(BuildBySweep);

Tree SweepSahBuilder::build(Boxes boxes, const Executor& executor) const {
    return HWY_DYNAMIC_DISPATCH(BuildBySweep)(boxes, executor);
}

BuilderEntry sweep_sah_builder() { return builder_entry<SweepSahBuilder>(); }

} // namespace boxwood
#endif
