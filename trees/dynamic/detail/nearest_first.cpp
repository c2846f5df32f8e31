// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/dynamic/detail/nearest_first.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/dynamic/detail/nearest_first.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t width = PackedLayout::width;
constexpr hn::CappedTag<float, width> df;
constexpr hn::RebindToUnsigned<decltype(df)> du;

/// A block of a level, with the bounds of its lanes and, where they count, its groups.
struct Place {
    std::size_t level, block;
    Box box;
    Groups groups{};
};

struct Blocks {
    const PackedLayout& layout;
    const LaneGroups* groups = nullptr;

    Place root() const {
        return {layout.depth() - 1, 0, layout.bounds(), groups ? groups->all() : Groups{}};
    }
    const PackedBlock& block(const Place& p) const { return layout.level(p.level)[p.block]; }
    Place child(const Place& p, std::size_t lane) const {
        return {p.level - 1, p.block * width + lane, block(p).lane(lane),
                groups ? groups->block(p.level, p.block).lane(lane) : Groups{}};
    }
    std::uint32_t item(const Place& p, std::size_t lane) const {
        return layout.items()[p.block * width + lane];
    }
};

/// The bits of a mask of the lanes [i, i + lanes), as those of the block.
template <class Mask> HWY_INLINE std::uint32_t bits_of(Mask mask, std::size_t i) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(df, mask, bits);
    return (bits[0] | std::uint32_t{bits[1]} << 8) << i;
}

/// The squares of the gaps between a box and the lanes of a block, infinite of an absent one, and
/// as bits which of them are below the limit, or at it if it is in.
template <bool limit_is_in>
HWY_INLINE std::uint32_t near_lanes(const PackedBlock& block, const Box& box, float limit,
                                    float* gaps) {
    std::uint32_t near = 0;
    for (std::size_t i = 0; i < width; i += hn::Lanes(df)) {
        const auto gap = [&](std::size_t axis) HWY_ATTR {
            const auto low = hn::Load(df, block.plane[axis] + i),
                       high = hn::Load(df, block.plane[3 + axis] + i);
            const auto beside =
                hn::Max(hn::Sub(low, hn::Set(df, box.max[static_cast<int>(axis)])),
                        hn::Sub(hn::Set(df, box.min[static_cast<int>(axis)]), high));
            const auto beyond = hn::Max(beside, hn::Zero(df));
            return hn::Mul(beyond, beyond);
        };
        const auto sum = hn::Add(hn::Add(gap(0), gap(1)), gap(2));
        hn::Store(sum, df, gaps + i);
        const auto most = hn::Set(df, limit);
        near |= bits_of(limit_is_in ? hn::Le(sum, most) : hn::Lt(sum, most), i);
    }
    return near;
}

/// As bits the lanes that may meet these groups: may_meet.
HWY_INLINE std::uint32_t meeting_lanes(const GroupBlock& block, const Groups& groups) {
    std::uint32_t meeting = 0;
    const auto own = hn::Set(du, groups.own), meets = hn::Set(du, groups.meets);
    for (std::size_t i = 0; i < width; i += hn::Lanes(du)) {
        const auto one = hn::Ne(hn::And(hn::Load(du, block.own + i), meets), hn::Zero(du));
        const auto other = hn::Ne(hn::And(hn::Load(du, block.meets + i), own), hn::Zero(du));
        meeting |= bits_of(hn::RebindMask(df, hn::And(one, other)), i);
    }
    return meeting;
}

/// What orders lanes at one gap from a box: of those that overlap it, how far the centres are
/// apart, squared, four times it.
HWY_INLINE float order_at(float gap, const Box& a, const Box& b) {
    float sum = 0;
    if (gap > 0)
        return sum;
    for (int axis = 0; axis < 3; ++axis) {
        const float d = (a.min[axis] + a.max[axis]) - (b.min[axis] + b.max[axis]);
        sum += d * d;
    }
    return sum;
}

/// Lanes of two blocks at hand by their gaps, and of one gap by an order: a float of 0 or more
/// above the upper part of another above two lanes, as one number.
template <std::size_t max> class Candidates {
  public:
    void add(float gap, float order, std::size_t a, std::size_t b) {
        all_[n_++] = std::uint64_t{std::bit_cast<std::uint32_t>(gap)} << 32 |
                     std::uint64_t{std::bit_cast<std::uint32_t>(order) >> 8} << 8 | a << 4 | b;
    }
    void sort() { std::sort(all_.begin(), all_.begin() + static_cast<std::ptrdiff_t>(n_)); }
    /// Calls visit(lane of a, lane of b) for those below the limit, which may shrink meanwhile,
    /// until it says false.
    template <class Visit> bool visit(const float& limit, const Visit& visit) const {
        for (std::size_t i = 0; i < n_; ++i) {
            if (!(std::bit_cast<float>(static_cast<std::uint32_t>(all_[i] >> 32)) < limit))
                return true;
            if (!visit(all_[i] >> 4 & 0xf, all_[i] & 0xf))
                return false;
        }
        return true;
    }

  private:
    static_assert(width <= 16);
    std::array<std::uint64_t, max> all_;
    std::size_t n_ = 0;
};

/// The recursion goes one level down in one tree at least, of the eight levels that there are.
/// in_order: the nearer first; else all at the limit or nearer, as they come.
template <bool in_order> class Descent {
  public:
    Descent(const Blocks& a, const Blocks& b, const float& limit, Work* work,
            NearestFirst::Decide decide)
        : a_(a), b_(b), limit_(limit), work_(work), decide_(decide) {}

    bool beside_box(const Place& p, const Box& box) const {
        return lanes_near(a_.block(p), box, [&](std::size_t lane) {
            return p.level == 0 ? decide_(a_.item(p, lane), 0) : beside_box(a_.child(p, lane), box);
        });
    }

    /// Two blocks of one level, in one tree the second not before the first.
    template <bool Self> bool side_by_side(const Place& p, const Place& q) const {
        [[maybe_unused]] Candidates<in_order ? width * width : 1> candidates;
        alignas(64) float gaps[width];
        const PackedBlock &rows = a_.block(p), &row = b_.block(q);
        const bool same = Self && p.block == q.block;
        const auto visit = [&](std::size_t a, std::size_t b) {
            if (p.level == 0)
                return decide_(a_.item(p, a), b_.item(q, b));
            const Place in_a = a_.child(p, a), in_b = b_.child(q, b);
            return side_by_side<Self>(in_a, in_b);
        };
        std::uint32_t bits = near(rows, q.box, gaps);
        if (Self && a_.groups)
            bits &= meeting_lanes(a_.groups->block(p.level, p.block), q.groups);
        for (; bits != 0; bits &= bits - 1) {
            const auto a = static_cast<std::size_t>(std::countr_zero(bits));
            std::uint32_t others = near(row, rows.lane(a), gaps);
            if (Self && a_.groups)
                others &= meeting_lanes(a_.groups->block(q.level, q.block),
                                        a_.groups->block(p.level, p.block).lane(a));
            if (same) // a block meets itself, an item does not
                others = others >> (a + (p.level == 0)) << (a + (p.level == 0));
            for (; others != 0; others &= others - 1) {
                const auto b = static_cast<std::size_t>(std::countr_zero(others));
                if constexpr (in_order)
                    candidates.add(gaps[b], 0, a, b); // a sort of up to 256 by centres costs more
                else if (!visit(a, b))
                    return false;
            }
        }
        if constexpr (in_order) {
            candidates.sort();
            return candidates.visit(limit_, visit);
        }
        return true;
    }

    /// Of two trees: the higher of the two is opened.
    bool between_trees(const Place& p, const Place& q) const {
        if (p.level == q.level)
            return side_by_side<false>(p, q);
        if (p.level > q.level)
            return lanes_near(a_.block(p), q.box, [&](std::size_t lane) {
                return between_trees(a_.child(p, lane), q);
            });
        return lanes_near(b_.block(q), p.box,
                          [&](std::size_t lane) { return between_trees(p, b_.child(q, lane)); });
    }

  private:
    HWY_INLINE std::uint32_t near(const PackedBlock& block, const Box& box, float* gaps) const {
        if (work_) {
            ++work_->node_visits;
            work_->box_tests += width;
        }
        return near_lanes<!in_order>(block, box, limit_, gaps);
    }
    template <class Visit>
    bool lanes_near(const PackedBlock& block, const Box& box, const Visit& visit) const {
        Candidates<width> candidates;
        alignas(64) float gaps[width];
        for (std::uint32_t bits = near(block, box, gaps); bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
            candidates.add(gaps[lane], order_at(gaps[lane], block.lane(lane), box), lane, 0);
        }
        candidates.sort();
        return candidates.visit(limit_, [&](std::size_t lane, std::size_t) { return visit(lane); });
    }

    Blocks a_, b_;
    const float& limit_;
    Work* work_;
    NearestFirst::Decide decide_;
};

bool nearest_to_box(const PackedLayout& tree, const Box& box, const float& limit, Work* work,
                    NearestFirst::Decide decide) {
    const Blocks blocks{tree};
    return Descent<true>(blocks, blocks, limit, work, decide).beside_box(blocks.root(), box);
}

bool nearest_self(const PackedLayout& tree, const LaneGroups* groups, const float& limit,
                  Work* work, NearestFirst::Decide decide) {
    const Blocks blocks{tree, groups};
    const Place root = blocks.root();
    return Descent<true>(blocks, blocks, limit, work, decide).side_by_side<true>(root, root);
}

bool near_self(const PackedLayout& tree, const LaneGroups* groups, const float& limit, Work* work,
               NearestFirst::Decide decide) {
    const Blocks blocks{tree, groups};
    const Place root = blocks.root();
    // An absent lane is infinitely far away.
    const float finite = std::min(limit, std::numeric_limits<float>::max());
    return Descent<false>(blocks, blocks, finite, work, decide).side_by_side<true>(root, root);
}

bool nearest_between(const PackedLayout& a, const PackedLayout& b, const float& limit, Work* work,
                     NearestFirst::Decide decide) {
    const Blocks in_a{a}, in_b{b};
    return Descent<true>(in_a, in_b, limit, work, decide).between_trees(in_a.root(), in_b.root());
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(nearest_to_box);
HWY_EXPORT(nearest_self);
HWY_EXPORT(near_self);
HWY_EXPORT(nearest_between);

bool NearestFirst::near_box(const PackedLayout& tree, const Box& box, Decide decide) const {
    return tree.empty() || HWY_DYNAMIC_DISPATCH(nearest_to_box)(tree, box, limit_, work_, decide);
}

bool NearestFirst::self_pairs(const PackedLayout& tree, Decide decide) const {
    return tree.empty() || HWY_DYNAMIC_DISPATCH(nearest_self)(tree, groups_, limit_, work_, decide);
}

bool NearestFirst::all_self_pairs(const PackedLayout& tree, Decide decide) const {
    return tree.empty() || HWY_DYNAMIC_DISPATCH(near_self)(tree, groups_, limit_, work_, decide);
}

bool NearestFirst::tree_pairs(const PackedLayout& a, const PackedLayout& b, Decide decide) const {
    return a.empty() || b.empty() ||
           HWY_DYNAMIC_DISPATCH(nearest_between)(a, b, limit_, work_, decide);
}

} // namespace boxwood::detail
#endif
