// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/builders/binned_sah.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/builders/binned_sah.h"
#include "trees/builders/detail/bins-inl.h"
#include "trees/builders/detail/join-inl.h"
#include "trees/builders/detail/prim8.h"
#include "trees/builders/detail/top_down_loop.h"
#include "trees/optimizers/refit.h"

#include <bit>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

/// A part with the bounds of its doubled centres, and which of the two arrays has its items.
struct BinnedPart : Subtree {
    std::uint32_t array;
    float centres[8];
};

HWY_INLINE void clear_centres(BinnedPart& part) { store_f8(set_f8(kLowest), part.centres); }

class BinnedSplitter {
  public:
    using Part = BinnedPart;

    BinnedSplitter(Boxes boxes, const BinnedSahBuilder& settings, const Executor& executor)
        : boxes_(boxes), executor_(executor), max_bins_(settings.bins),
          whole_(static_cast<std::uint32_t>(settings.unsplit_below)),
          unsplit_(std::max(static_cast<std::uint32_t>(settings.agglomerate_below), whole_)),
          block_bits_(
              static_cast<int>(std::bit_width(static_cast<std::uint32_t>(settings.leaf_size))) - 1),
          items_(boxes, executor), other_(boxes.size()), tree_(boxes.size()),
          max_depth_(2 * static_cast<std::uint32_t>(std::bit_width(boxes.size())) + 17) {}

    Tree run() {
        const auto n = static_cast<std::uint32_t>(boxes_.size());
        if (n == 0)
            return std::move(tree_);
        Part root{{0, 0, n, 0}, 0, {}};
        std::copy_n(items_.centres, 8, root.centres);
        build_by_splitter(*this, root, executor_, std::max(slice_size, n / 32), max_depth_);
        if (items_.scale != 1)
            refit(tree_, boxes_);
        return std::move(tree_);
    }

    bool is_split(const Part& part) const {
        return part.count > 1 && (part.count > unsplit_ || part.depth > max_depth_);
    }

    Halves<Part> split(const Part& r) {
        if (r.depth > max_depth_)
            return halve_part(r, false);
        const Binning binning(r.centres, r.count, max_bins_);
        Bin bins[kMaxBins];
        if (binning.is_flat())
            return halve_part(r, true);
        clear(bins, binning.n_bins);
        add_items(items_of(r), r.count, binning, bins);
        const Plane plane = cheapest_plane(bins, binning, r.count, block_bits_);
        if (plane.axis < 0)
            return halve_part(r, true);
        write_box_of_bins(r, bins, binning.n_bins);
        std::uint32_t n_left = 0;
        for (int b = 0; b < plane.bin; ++b)
            n_left += bins[b].count[plane.axis];
        Halves<Part> h = split_children(r, n_left, r.array ^ 1);
        clear_centres(h.left);
        clear_centres(h.right);
        partition(items_of(r), r.count, binning, plane, items_of(h.left), 0, n_left, h.left.centres,
                  h.right.centres);
        return h;
    }

    void finish(const Part& r) {
        if (r.count <= whole_)
            halve_as_they_lie(items_of(r), r.count, {r.node, r.first}, tree_);
        else
            join(items_of(r), r.count, Binning(r.centres, r.count, 2).edge, {r.node, r.first},
                 tree_);
    }
    void build(const Part& part) { build_below(*this, part); }

    /// In slices of the items, so that all threads have work where parts are few.
    void split_level(const std::vector<Part>& large, std::vector<Halves<Part>>& children) {
        struct Slice {
            std::size_t range;
            std::uint32_t from, count, n_left;
            float left_centres[8], right_centres[8];
            Bin bins[kMaxBins];
        };
        struct Choice {
            Binning binning;
            Plane plane;
        };
        std::vector<Slice> slices;
        std::vector<Choice> choices;
        for (std::size_t i = 0; i < large.size(); ++i) {
            choices.push_back({Binning(large[i].centres, large[i].count, max_bins_), {}});
            for (std::uint32_t from = 0; from < large[i].count; from += slice_size) {
                slices.emplace_back();
                slices.back().range = i;
                slices.back().from = from;
                slices.back().count = std::min(slice_size, large[i].count - from);
            }
        }
        executor_.for_each(slices.size(), [&](std::size_t i) {
            Slice& s = slices[i];
            const Binning& binning = choices[s.range].binning;
            clear(s.bins, binning.n_bins);
            add_items(items_of(large[s.range]) + s.from, s.count, binning, s.bins);
        });
        // The bins of each range come together; n_left becomes the number left of
        // the slice.
        for (std::size_t i = 0, next = 0; i < large.size(); ++i) {
            Choice& choice = choices[i];
            Bin bins[kMaxBins];
            clear(bins, choice.binning.n_bins);
            std::size_t end = next;
            for (; end < slices.size() && slices[end].range == i; ++end)
                add(bins, slices[end].bins, choice.binning.n_bins);
            if (!choice.binning.is_flat())
                choice.plane = cheapest_plane(bins, choice.binning, large[i].count, block_bits_);
            std::uint32_t n_left = 0;
            for (; next < end; ++next) {
                slices[next].n_left = n_left;
                if (choice.plane.axis >= 0)
                    for (int b = 0; b < choice.plane.bin; ++b)
                        n_left += slices[next].bins[b].count[choice.plane.axis];
            }
            if (choice.plane.axis < 0) {
                children[i] = halve_part(large[i], true);
                continue;
            }
            write_box_of_bins(large[i], bins, choice.binning.n_bins);
            children[i] = split_children(large[i], n_left, large[i].array ^ 1);
            clear_centres(children[i].left);
            clear_centres(children[i].right);
        }
        executor_.for_each(slices.size(), [&](std::size_t i) {
            Slice& s = slices[i];
            const Choice& choice = choices[s.range];
            Halves<Part>& h = children[s.range];
            store_f8(set_f8(kLowest), s.left_centres);
            store_f8(set_f8(kLowest), s.right_centres);
            if (choice.plane.axis >= 0)
                partition(items_of(large[s.range]) + s.from, s.count, choice.binning, choice.plane,
                          items_of(h.left), s.n_left, h.left.count + (s.from - s.n_left),
                          s.left_centres, s.right_centres);
        });
        for (const Slice& s : slices) {
            Halves<Part>& h = children[s.range];
            store_f8(max_f8(load_f8(h.left.centres), load_f8(s.left_centres)), h.left.centres);
            store_f8(max_f8(load_f8(h.right.centres), load_f8(s.right_centres)), h.right.centres);
        }
    }

  private:
    static constexpr std::uint32_t slice_size = 1 << 12;

    Prim8* items_of(const Part& r) { return (r.array ? other_ : items_.prims).data() + r.first; }

    void write_inner(const Part& r, F8 box) {
        write_node(box, r.first, r.count, tree_.nodes[r.node]);
    }

    /// The children of a part of which `n_left` go left; their centres are left to the caller.
    static Halves<Part> split_children(const Part& part, std::uint32_t n_left,
                                       std::uint32_t array) {
        const auto [left, right] = children_of(part, n_left);
        Halves<Part> h;
        static_cast<Subtree&>(h.left) = left;
        static_cast<Subtree&>(h.right) = right;
        h.left.array = h.right.array = array;
        return h;
    }

    /// Halves that stay in their array: for centres that coincide, or for too great a depth.
    Halves<Part> halve_part(const Part& r, bool coincide) {
        write_inner(r, bounds_of_boxes(items_of(r), r.count));
        const auto n_left = static_cast<std::uint32_t>(
            coincide ? r.count / 2 : halve({items_of(r), r.count}, r.centres));
        Halves<Part> h = split_children(r, n_left, r.array);
        store_f8(bounds_of_centres(items_of(h.left), h.left.count), h.left.centres);
        store_f8(bounds_of_centres(items_of(h.right), h.right.count), h.right.centres);
        return h;
    }

    void write_box_of_bins(const Part& r, const Bin* bins, int n_bins) {
        F8 box = load_f8(bins[0].box[0]);
        for (int b = 1; b < n_bins; ++b)
            box = max_f8(box, load_f8(bins[b].box[0]));
        write_inner(r, box);
    }

    Boxes boxes_;
    const Executor& executor_;
    const int max_bins_;
    const std::uint32_t whole_, unsplit_;
    const int block_bits_;
    Prims8 items_;
    Buffer<Prim8> other_;
    Tree tree_;
    const std::uint32_t max_depth_;
};

Tree build_binned(Boxes boxes, const BinnedSahBuilder& settings, const Executor& executor) {
    return BinnedSplitter(boxes, settings, executor).run();
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(build_binned);
}

namespace boxwood {
using namespace detail;

Tree BinnedSahBuilder::build(Boxes boxes, const Executor& executor) const {
    return HWY_DYNAMIC_DISPATCH(build_binned)(boxes, *this, executor);
}

BuilderEntry binned_sah_builder() { return builder_entry<BinnedSahBuilder>(); }

} // namespace boxwood
#endif
