// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/adapters/detail/nearest_first.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/adapters/detail/nearest_first.h"

#include <array>
#include <bit>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t width = PackedLayout::width;
constexpr hn::CappedTag<float, width> df;

/// A block of a level, with the bounds of its lanes.
struct Place {
    std::size_t level, block;
    Box box;
};

struct Blocks {
    const PackedLayout& layout;

    Place root() const { return {layout.depth() - 1, 0, layout.bounds()}; }
    const PackedBlock& block(const Place& p) const { return layout.level(p.level)[p.block]; }
    Place child(const Place& p, std::size_t lane) const {
        return {p.level - 1, p.block * width + lane, block(p).lane(lane)};
    }
    std::uint32_t item(const Place& p, std::size_t lane) const {
        return layout.items()[p.block * width + lane];
    }
};

/// The squares of the gaps between a box and the lanes of a block, infinite of an absent one, and
/// as bits which of them are below the limit.
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
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(df, hn::Lt(sum, hn::Set(df, limit)), bits);
        near |= (bits[0] | std::uint32_t{bits[1]} << 8) << i;
    }
    return near;
}

/// Lanes of two blocks at hand by their gaps: a float of 0 or more above its lanes, as one number.
template <std::size_t max> class Candidates {
  public:
    void add(float gap, std::size_t a, std::size_t b) {
        all_[n_++] = std::uint64_t{std::bit_cast<std::uint32_t>(gap)} << 32 | a << 8 | b;
    }
    void sort() { std::sort(all_.begin(), all_.begin() + static_cast<std::ptrdiff_t>(n_)); }
    /// Calls visit(lane of a, lane of b) for those below the limit, which may shrink meanwhile,
    /// until it says false.
    template <class Visit> bool visit(const float& limit, const Visit& visit) const {
        for (std::size_t i = 0; i < n_; ++i) {
            if (!(std::bit_cast<float>(static_cast<std::uint32_t>(all_[i] >> 32)) < limit))
                return true;
            if (!visit(all_[i] >> 8 & 0xff, all_[i] & 0xff))
                return false;
        }
        return true;
    }

  private:
    std::array<std::uint64_t, max> all_;
    std::size_t n_ = 0;
};

/// The recursion goes one level down in one tree at least, of the eight levels that there are.
class Descent {
  public:
    Descent(const PackedLayout& a, const PackedLayout& b, const float& limit,
            NearestFirst::Decide decide)
        : a_{a}, b_{b}, limit_(limit), decide_(decide) {}

    bool beside_box(const Place& p, const Box& box) const {
        return lanes_near(a_.block(p), box, [&](std::size_t lane) {
            return p.level == 0 ? decide_(a_.item(p, lane), 0) : beside_box(a_.child(p, lane), box);
        });
    }

    /// Two blocks of one level, in one tree the second not before the first.
    template <bool Self> bool side_by_side(const Place& p, const Place& q) const {
        Candidates<width * width> near;
        alignas(64) float gaps[width];
        const PackedBlock &rows = a_.block(p), &row = b_.block(q);
        const bool same = Self && p.block == q.block;
        for (std::uint32_t bits = near_lanes(rows, q.box, limit_, gaps); bits != 0;
             bits &= bits - 1) {
            const auto a = static_cast<std::size_t>(std::countr_zero(bits));
            std::uint32_t others = near_lanes(row, rows.lane(a), limit_, gaps);
            if (same) // a block meets itself, an item does not
                others = others >> (a + (p.level == 0)) << (a + (p.level == 0));
            for (; others != 0; others &= others - 1) {
                const auto b = static_cast<std::size_t>(std::countr_zero(others));
                near.add(gaps[b], a, b);
            }
        }
        near.sort();
        return near.visit(limit_, [&](std::size_t a, std::size_t b) {
            if (p.level == 0)
                return decide_(a_.item(p, a), b_.item(q, b));
            const Place in_a = a_.child(p, a), in_b = b_.child(q, b);
            return side_by_side<Self>(in_a, in_b);
        });
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
    template <class Visit>
    bool lanes_near(const PackedBlock& block, const Box& box, const Visit& visit) const {
        Candidates<width> near;
        alignas(64) float gaps[width];
        for (std::uint32_t bits = near_lanes(block, box, limit_, gaps); bits != 0;
             bits &= bits - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
            near.add(gaps[lane], lane, 0);
        }
        near.sort();
        return near.visit(limit_, [&](std::size_t lane, std::size_t) { return visit(lane); });
    }

    Blocks a_, b_;
    const float& limit_;
    NearestFirst::Decide decide_;
};

bool nearest_to_box(const PackedLayout& tree, const Box& box, const float& limit,
                    NearestFirst::Decide decide) {
    return Descent(tree, tree, limit, decide).beside_box(Blocks{tree}.root(), box);
}

bool nearest_self(const PackedLayout& tree, const float& limit, NearestFirst::Decide decide) {
    const Place root = Blocks{tree}.root();
    return Descent(tree, tree, limit, decide).side_by_side<true>(root, root);
}

bool nearest_between(const PackedLayout& a, const PackedLayout& b, const float& limit,
                     NearestFirst::Decide decide) {
    return Descent(a, b, limit, decide).between_trees(Blocks{a}.root(), Blocks{b}.root());
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(nearest_to_box);
HWY_EXPORT(nearest_self);
HWY_EXPORT(nearest_between);

bool NearestFirst::near_box(const PackedLayout& tree, const Box& box, Decide decide) const {
    return tree.empty() || HWY_DYNAMIC_DISPATCH(nearest_to_box)(tree, box, limit_, decide);
}

bool NearestFirst::self_pairs(const PackedLayout& tree, Decide decide) const {
    return tree.empty() || HWY_DYNAMIC_DISPATCH(nearest_self)(tree, limit_, decide);
}

bool NearestFirst::tree_pairs(const PackedLayout& a, const PackedLayout& b, Decide decide) const {
    return a.empty() || b.empty() || HWY_DYNAMIC_DISPATCH(nearest_between)(a, b, limit_, decide);
}

} // namespace boxwood::detail
#endif
