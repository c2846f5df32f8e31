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

#include "trees/optimizers/refit.h"

#include <bit>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

/// A subtree to build: where it goes, how deep it hangs, and which of the two
/// arrays has its items.
struct Range {
    float centres[8];
    std::uint32_t node, first, count;
    std::uint16_t depth;
    std::uint16_t array;
};

HWY_INLINE void ClearCentres(Range& r) { StoreF8(SetF8(kLeast), r.centres); }

class BinnedBuild {
  public:
    BinnedBuild(Boxes boxes, int most_bins, std::uint32_t joined, std::uint32_t block,
                std::uint32_t whole, const Executor& executor)
        : boxes_(boxes), executor_(executor), most_bins_(most_bins),
          unsplit_(std::max(joined, whole)), whole_(whole), block_bits_(std::bit_width(block) - 1),
          items_(boxes, executor), other_(boxes.size()), tree_(boxes.size()),
          depth_limit_(2 * static_cast<std::uint32_t>(std::bit_width(boxes.size())) + 17) {}

    Tree Run() {
        const auto n = static_cast<std::uint32_t>(boxes_.size());
        if (n == 0)
            return std::move(tree_);
        Range root{{}, 0, 0, n, 0, 0};
        std::copy_n(items_.centres, 8, root.centres);
        const std::vector<Range> subtrees =
            executor_.threads() > 1 ? SplitTop(root) : std::vector{root};
        executor_.for_each(subtrees.size(), [&](std::size_t i) { BuildSubtree(subtrees[i]); });
        if (items_.scale != 1)
            refit(tree_, boxes_);
        return std::move(tree_);
    }

  private:
    Prim8* Items(const Range& r) { return (r.array ? other_ : items_.prims).data() + r.first; }

    void WriteInner(const Range& r, F8 box) {
        WriteNode(box, r.first, r.count, tree_.nodes[r.node]);
    }

    struct Halves {
        Range left, right;
    };

    /// The children of a range of which `n_left` go left; their centres are left
    /// to the caller.
    static Halves Children(const Range& r, std::uint32_t n_left, std::uint16_t array) {
        const auto depth = static_cast<std::uint16_t>(r.depth + 1);
        Halves h;
        h.left.node = r.node + 1;
        h.left.first = r.first;
        h.left.count = n_left;
        h.right.node = r.node + 2 * n_left;
        h.right.first = r.first + n_left;
        h.right.count = r.count - n_left;
        h.left.depth = h.right.depth = depth;
        h.left.array = h.right.array = array;
        return h;
    }

    /// Halves that stay in their array: for centres that coincide, or for too
    /// great a depth.
    Halves Halve(const Range& r, bool coincide) {
        WriteInner(r, BoundsOfBoxes(Items(r), r.count));
        const auto n_left = static_cast<std::uint32_t>(
            coincide ? r.count / 2 : halve({Items(r), r.count}, r.centres));
        Halves h = Children(r, n_left, r.array);
        StoreF8(BoundsOfCentres(Items(h.left), h.left.count), h.left.centres);
        StoreF8(BoundsOfCentres(Items(h.right), h.right.count), h.right.centres);
        return h;
    }

    void WriteBoxOfBins(const Range& r, const Bin* bins, int n_bins) {
        F8 box = LoadF8(bins[0].box[0]);
        for (int b = 1; b < n_bins; ++b)
            box = MaxF8(box, LoadF8(bins[b].box[0]));
        WriteInner(r, box);
    }

    Halves Split(const Range& r) {
        if (r.depth > depth_limit_)
            return Halve(r, false);
        const Binning binning(r.centres, r.count, most_bins_);
        Bin bins[kMostBins];
        if (binning.is_flat())
            return Halve(r, true);
        Clear(bins, binning.n_bins);
        AddItems(Items(r), r.count, binning, bins);
        const Plane plane = CheapestPlane(bins, binning, r.count, block_bits_);
        if (plane.axis < 0)
            return Halve(r, true);
        WriteBoxOfBins(r, bins, binning.n_bins);
        std::uint32_t n_left = 0;
        for (int b = 0; b < plane.bin; ++b)
            n_left += bins[b].count[plane.axis];
        Halves h = Children(r, n_left, !r.array);
        ClearCentres(h.left);
        ClearCentres(h.right);
        Part(Items(r), r.count, binning, plane, Items(h.left), 0, n_left, h.left.centres,
             h.right.centres);
        return h;
    }

    void BuildSubtree(const Range& root) {
        // The smaller half is taken at once and the larger waits, so 32 entries
        // always suffice.
        Range waiting[32];
        std::size_t n_waiting = 0;
        Range r = root;
        for (;;) {
            if (r.count > 1 && (r.count > unsplit_ || r.depth > depth_limit_)) {
                Halves h = Split(r);
                const bool left_first = h.left.count <= h.right.count;
                waiting[n_waiting++] = left_first ? h.right : h.left;
                r = left_first ? h.left : h.right;
                continue;
            }
            if (r.count <= whole_)
                HalveAsTheyLie(Items(r), r.count, {r.node, r.first}, tree_);
            else
                Join(Items(r), r.count, Binning(r.centres, r.count, 2).edge, {r.node, r.first},
                     tree_);
            if (n_waiting == 0)
                break;
            r = waiting[--n_waiting];
        }
    }

    /// Splits the top of the tree a level at a time, in slices of the items,
    /// until no part is much of the whole.
    std::vector<Range> SplitTop(const Range& root) {
        constexpr std::uint32_t slice = 1 << 12;
        const std::uint32_t enough = std::max(slice, root.count / 32);
        struct Slice {
            std::size_t range;
            std::uint32_t from, count, n_left;
            float left_centres[8], right_centres[8];
            Bin bins[kMostBins];
        };
        struct Split1 {
            Binning binning;
            Plane plane;
            Halves halves;
        };
        std::vector<Range> frontier{root}, done;
        while (!frontier.empty()) {
            std::vector<Range> large;
            for (const Range& r : frontier)
                (r.count > enough && r.depth <= depth_limit_ ? large : done).push_back(r);
            std::vector<Slice> slices;
            std::vector<Split1> splits;
            for (std::size_t i = 0; i < large.size(); ++i) {
                splits.push_back({Binning(large[i].centres, large[i].count, most_bins_), {}, {}});
                for (std::uint32_t from = 0; from < large[i].count; from += slice) {
                    slices.emplace_back();
                    slices.back().range = i;
                    slices.back().from = from;
                    slices.back().count = std::min(slice, large[i].count - from);
                }
            }
            executor_.for_each(slices.size(), [&](std::size_t i) {
                Slice& s = slices[i];
                const Binning& binning = splits[s.range].binning;
                Clear(s.bins, binning.n_bins);
                AddItems(Items(large[s.range]) + s.from, s.count, binning, s.bins);
            });
            // The bins of each range come together; n_left becomes the number left of
            // the slice.
            for (std::size_t i = 0, next = 0; i < large.size(); ++i) {
                Split1& split = splits[i];
                Bin bins[kMostBins];
                Clear(bins, split.binning.n_bins);
                std::size_t end = next;
                for (; end < slices.size() && slices[end].range == i; ++end)
                    Add(bins, slices[end].bins, split.binning.n_bins);
                if (!split.binning.is_flat())
                    split.plane = CheapestPlane(bins, split.binning, large[i].count, block_bits_);
                std::uint32_t n_left = 0;
                for (; next < end; ++next) {
                    slices[next].n_left = n_left;
                    if (split.plane.axis >= 0)
                        for (int b = 0; b < split.plane.bin; ++b)
                            n_left += slices[next].bins[b].count[split.plane.axis];
                }
                if (split.plane.axis < 0) {
                    split.halves = Halve(large[i], true);
                    continue;
                }
                WriteBoxOfBins(large[i], bins, split.binning.n_bins);
                split.halves = Children(large[i], n_left, !large[i].array);
                ClearCentres(split.halves.left);
                ClearCentres(split.halves.right);
            }
            executor_.for_each(slices.size(), [&](std::size_t i) {
                Slice& s = slices[i];
                const Split1& split = splits[s.range];
                StoreF8(SetF8(kLeast), s.left_centres);
                StoreF8(SetF8(kLeast), s.right_centres);
                if (split.plane.axis >= 0)
                    Part(Items(large[s.range]) + s.from, s.count, split.binning, split.plane,
                         Items(split.halves.left), s.n_left,
                         split.halves.left.count + (s.from - s.n_left), s.left_centres,
                         s.right_centres);
            });
            for (const Slice& s : slices) {
                Halves& h = splits[s.range].halves;
                StoreF8(MaxF8(LoadF8(h.left.centres), LoadF8(s.left_centres)), h.left.centres);
                StoreF8(MaxF8(LoadF8(h.right.centres), LoadF8(s.right_centres)), h.right.centres);
            }
            frontier.clear();
            for (const Split1& split : splits) {
                frontier.push_back(split.halves.left);
                frontier.push_back(split.halves.right);
            }
        }
        std::ranges::sort(done, std::ranges::greater{}, &Range::count);
        return done;
    }

    Boxes boxes_;
    const Executor& executor_;
    const int most_bins_;
    const std::uint32_t unsplit_, whole_;
    const int block_bits_;
    Prims8 items_;
    Buffer<Prim8> other_;
    Tree tree_;
    const std::uint32_t depth_limit_;
};

Tree BuildBinned(Boxes boxes, int most_bins, std::uint32_t joined, std::uint32_t block,
                 std::uint32_t whole, const Executor& executor) {
    return BinnedBuild(boxes, most_bins, joined, block, whole, executor).Run();
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(BuildBinned);

Tree BinnedSahBuilder::build(Boxes boxes, const Executor& executor) const {
    return HWY_DYNAMIC_DISPATCH(BuildBinned)(
        boxes, static_cast<int>(bins), static_cast<std::uint32_t>(joined),
        static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(whole), executor);
}

BuilderEntry binned_sah_builder() { return builder_entry<BinnedSahBuilder>(); }

} // namespace boxwood
#endif
