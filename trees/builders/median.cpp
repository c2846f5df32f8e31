// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/builders/median.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/builders/detail/prim8-inl.h"
#include "trees/builders/detail/top_down_loop.h"
#include "trees/builders/median.h"
#include "trees/optimizers/refit.h"

#include <algorithm>
#include <limits>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

/// The items go from one array to the other with each level.
class MedianSplitter {
  public:
    using Part = Subtree;

    MedianSplitter(Boxes boxes, const Executor& executor)
        : boxes_(boxes), executor_(executor), items_(boxes, executor), other_(boxes.size()),
          keys_(boxes.size()), tree_(boxes.size()) {}

    Tree run() {
        const auto n = static_cast<std::uint32_t>(boxes_.size());
        if (n == 0)
            return std::move(tree_);
        build_by_splitter(*this, Part{0, 0, n, 0}, executor_, std::max(2048u, n / 32 + 1));
        if (items_.scale != 1)
            refit(tree_, boxes_);
        return std::move(tree_);
    }

    bool is_split(const Part& part) const { return part.count > 1; }

    /// Each side comes in its old order, into the other array.
    Halves<Part> split(const Part& r) {
        const Prim8* prims = items_of(r);
        F8 box = set_f8(kLowest), centres = box;
        for (std::uint32_t i = 0; i < r.count; ++i) {
            const F8 each = load_f8(prims[i].v);
            box = max_f8(box, each);
            centres = max_f8(centres, doubled_centre(each));
        }
        write_node(box, r.first, r.count, tree_.nodes[r.node]);
        float c[8];
        store_f8(centres, c);
        const float x = c[0] + c[4], y = c[1] + c[5], z = c[2] + c[6];
        const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
        const std::int64_t pivot = pivot_of(prims, r, axis, -c[4 + axis], c[axis]);

        Prim8* to = array_of(r.depth + 1) + r.first;
        const std::uint32_t n_left = r.count / 2;
        // Without a branch: it would be mispredicted half the time.
        std::size_t left = 0, right = n_left;
        for (std::uint32_t i = 0; i < r.count; ++i) {
            const std::size_t goes_left = key_of(prims[i], axis) < pivot;
            const std::size_t at = right ^ ((left ^ right) & (0 - goes_left));
            store_f8(load_f8(prims[i].v), to[at].v);
            left += goes_left;
            right += 1 - goes_left;
        }
        return children_of(r, n_left);
    }

    void finish(const Part& part) {
        const Prim8& p = *items_of(part);
        write_node(load_f8(p.v), part.first, 1, tree_.nodes[part.node]);
        tree_.order[part.first] = p.item();
    }
    void build(const Part& part) { build_below(*this, part); }

  private:
    Prim8* array_of(std::uint32_t depth) { return (depth % 2 ? other_ : items_.prims).data(); }
    Prim8* items_of(const Part& part) { return array_of(part.depth) + part.first; }

    /// The order of the centres, ties by item: bits in the order of the numbers, then the item.
    static std::int64_t key_of(const Prim8& p, int axis) {
        const auto bits = std::bit_cast<std::int32_t>(p.doubled_centre(axis) + 0.f);
        return std::int64_t{bits ^ (bits >> 31 & 0x7fffffff)} * (std::int64_t{1} << 32) | p.item();
    }

    /// The key with half of the at most 64 keys below it: counts for each key those below it, as
    /// comparisons cost less than mispredicted branches.
    static std::int64_t pivot_of_few(const Prim8* prims, std::uint32_t n, int axis) {
        namespace hn = hwy::HWY_NAMESPACE;
        constexpr hn::CappedTag<std::int64_t, 8> d;
        alignas(64) std::int64_t keys[64 + 8];
        for (std::uint32_t i = 0; i < n; ++i)
            keys[i] = key_of(prims[i], axis);
        for (std::uint32_t i = n; i < n + 8; ++i)
            keys[i] = std::numeric_limits<std::int64_t>::max();
        std::int64_t pivot = keys[0];
        for (std::uint32_t i = 0; i < n; ++i) {
            const auto key = hn::Set(d, keys[i]);
            std::size_t below = 0;
            for (std::size_t from = 0; from < n; from += hn::Lanes(d))
                below += hn::CountTrue(d, hn::Lt(hn::Load(d, keys + from), key));
            pivot = below == n / 2 ? keys[i] : pivot;
        }
        return pivot;
    }

    /// The key with half of the keys below it.
    std::int64_t pivot_of(const Prim8* prims, const Part& r, int axis, float low, float high) {
        if (r.count <= 64)
            return pivot_of_few(prims, r.count, axis);
        std::int64_t* keys = keys_.data() + r.first;
        std::size_t n = 0, left = r.count / 2;
        // Only the keys of the bin that has the middle need a closer look.
        constexpr std::size_t bins = 256;
        const float spread = high - low;
        const float scale = spread > 0x1p-90f ? float{bins} / spread : 0;
        const auto bin_of = [&](const Prim8& p) {
            return std::clamp(static_cast<int>((p.doubled_centre(axis) - low) * scale), 0,
                              static_cast<int>(bins) - 1);
        };
        std::uint32_t count[bins] = {};
        for (std::uint32_t i = 0; i < r.count; ++i)
            ++count[bin_of(prims[i])];
        int bin = 0;
        for (; left >= count[bin]; ++bin)
            left -= count[bin];
        for (std::uint32_t i = 0; i < r.count; ++i) {
            keys[n] = key_of(prims[i], axis);
            n += bin_of(prims[i]) == bin;
            if (n == count[bin])
                break;
        }
        std::nth_element(keys, keys + left, keys + n);
        return keys[left];
    }

    Boxes boxes_;
    const Executor& executor_;
    Prims8 items_;
    Buffer<Prim8> other_;
    Buffer<std::int64_t> keys_;
    Tree tree_;
};

Tree build_by_medians(Boxes boxes, const Executor& executor) {
    return MedianSplitter(boxes, executor).run();
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(build_by_medians);
}

namespace boxwood {
using namespace detail;

Tree MedianBuilder::build(Boxes boxes, const Executor& executor) const {
    return HWY_DYNAMIC_DISPATCH(build_by_medians)(boxes, executor);
}

BuilderEntry median_builder() { return builder_entry<MedianBuilder>(); }

} // namespace boxwood
#endif
