// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_BINS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_BINS_INL_H
#undef BOXWOOD_BINS_INL_H
#else
#define BOXWOOD_BINS_INL_H
#endif

#include <hwy/highway.h>

#include "trees/builders/detail/prim8-inl.h"

#include <bit>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// One bin on each axis: 128 bytes, so that 32 of them fill 4 KiB and no two share their low
/// address bits.
struct alignas(128) Bin {
    float box[3][8]; ///< (max, -min)
    std::uint32_t count[4];
    std::uint32_t unused[4];
};
inline constexpr int kMaxBins = 32;

/// Which bin a doubled centre falls in on each axis: (centre - low) * scale + 1 lies in [1, 2), and
/// the five upper bits of its mantissa are the bin. Clamped even where rounding "cannot" leave the
/// range. Never NaN: no spread, or one that is next to nothing, has scale 0.
struct Binning {
    alignas(16) float low[4], scale[4];
    int n_bins;
    float last; ///< where the last bin starts
    float edge; ///< next to nothing by the size of the node; see `join`

    Binning(const float (&centres)[8], std::size_t n, int max_bins)
        : n_bins(static_cast<int>(
              std::min<std::size_t>(static_cast<std::size_t>(max_bins), 4 + n / 8))),
          last(start(n_bins - 1)) {
        float max_spread = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const float spread = centres[axis] + centres[4 + axis];
            low[axis] = -centres[4 + axis];
            scale[axis] = spread > 0x1p-90f ? static_cast<float>(n_bins) / 32 / spread : 0;
            max_spread = std::max(max_spread, spread);
        }
        low[3] = scale[3] = 0;
        edge = max_spread * 0x1p-20f;
    }
    static float start(int bin) { return 1 + static_cast<float>(bin) / 32; }
    float position(float doubled_centre, int axis) const {
        return std::clamp((doubled_centre - low[axis]) * scale[axis] + 1, 1.f, last);
    }
    bool is_flat() const { return scale[0] == 0 && scale[1] == 0 && scale[2] == 0; }
};

HWY_INLINE void clear(Bin* bins, int n_bins) {
    for (int b = 0; b < n_bins; ++b) {
        for (auto& box : bins[b].box)
            store_f8(set_f8(kLowest), box);
        for (std::uint32_t& count : bins[b].count)
            count = 0;
    }
}

HWY_INLINE void add(Bin* bins, const Bin* from, int n_bins) {
    for (int b = 0; b < n_bins; ++b)
        for (int axis = 0; axis < 3; ++axis) {
            store_f8(max_f8(load_f8(bins[b].box[axis]), load_f8(from[b].box[axis])),
                     bins[b].box[axis]);
            bins[b].count[axis] += from[b].count[axis];
        }
}

/// Adds the items to their bins.
HWY_INLINE void add_items(const Prim8* prims, std::size_t n, const Binning& binning, Bin* bins) {
#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
    namespace hn = hwy::HWY_NAMESPACE;
    constexpr hn::FixedTag<float, 4> d;
    constexpr hn::FixedTag<std::uint32_t, 4> du;
    const auto low = hn::Load(d, binning.low), scale = hn::Load(d, binning.scale),
               first = hn::Set(d, 1), last = hn::Set(d, binning.last);
    const auto mantissa = hn::Set(du, 0x007c0000);
    for (std::size_t i = 0; i < n; ++i) {
        const F8 box = load_f8(prims[i].v);
        const auto centre = hn::LowerHalf(d, doubled_centre(box).v);
        const auto at = hn::Add(hn::Mul(hn::Sub(centre, low), scale), first);
        const auto bits = hn::BitCast(du, hn::Max(hn::Min(at, last), first));
        alignas(16) std::uint32_t bin[4];
        hn::Store(hn::ShiftRight<18>(hn::And(bits, mantissa)), du, bin);
        Bin &x = bins[bin[0]], &y = bins[bin[1]], &z = bins[bin[2]];
        const F8 grown_x = max_f8(load_f8(x.box[0]), box), grown_y = max_f8(load_f8(y.box[1]), box),
                 grown_z = max_f8(load_f8(z.box[2]), box);
        store_f8(grown_x, x.box[0]);
        store_f8(grown_y, y.box[1]);
        store_f8(grown_z, z.box[2]);
        ++x.count[0];
        ++y.count[1];
        ++z.count[2];
    }
#else
    for (std::size_t i = 0; i < n; ++i) {
        const F8 box = load_f8(prims[i].v);
        for (int axis = 0; axis < 3; ++axis) {
            const float at = binning.position(prims[i].doubled_centre(axis), axis);
            Bin& b = bins[std::bit_cast<std::uint32_t>(at) >> 18 & 31];
            store_f8(max_f8(load_f8(b.box[axis]), box), b.box[axis]);
            ++b.count[axis];
        }
    }
#endif
}

/// The items whose centre is below bin `bin` of the axis go left. No axis: no plane parts the
/// items.
struct Plane {
    int axis = -1, bin = 0;
    float cost = std::numeric_limits<float>::infinity();
};

#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE

using F4 = hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::FixedTag<float, 4>>;

/// Half areas of three boxes whose edges are lengthened, xy + z (x + y) each; a fourth lane of no
/// meaning.
HWY_INLINE F4 half_areas(F8 a, F8 b, F8 c, F4 edge) {
    namespace hn = hwy::HWY_NAMESPACE;
    constexpr hn::FixedTag<float, 4> d;
    const auto size = [&](F8 box) {
        return hn::Add(hn::Add(hn::LowerHalf(d, box.v), hn::UpperHalf(d, box.v)), edge);
    };
    const auto sa = size(a), sb = size(b), sc = size(c);
    const auto ac = hn::InterleaveLower(d, sa, sc), bb = hn::InterleaveLower(d, sb, sb);
    const auto x = hn::InterleaveLower(d, ac, bb), y = hn::InterleaveUpper(d, ac, bb);
    const auto z =
        hn::InterleaveLower(d, hn::InterleaveUpper(d, sa, sc), hn::InterleaveUpper(d, sb, sb));
    return hn::Add(hn::Mul(x, y), hn::Mul(z, hn::Add(x, y)));
}

/// The cheapest plane, by blocks of 2^block_bits items times half area; the first of equals.
HWY_INLINE Plane cheapest_plane(const Bin* bins, const Binning& binning, std::uint32_t n,
                                int block_bits) {
    namespace hn = hwy::HWY_NAMESPACE;
    constexpr hn::FixedTag<float, 4> d;
    constexpr hn::FixedTag<std::int32_t, 4> di;
    const auto edge = hn::Set(d, binning.edge);
    alignas(16) float right_area[kMaxBins][4];
    F8 x = set_f8(kLowest), y = x, z = x;
    const auto grow = [&](const Bin& bin) {
        x = max_f8(x, load_f8(bin.box[0]));
        y = max_f8(y, load_f8(bin.box[1]));
        z = max_f8(z, load_f8(bin.box[2]));
    };
    for (int b = binning.n_bins; --b > 0;) {
        grow(bins[b]);
        hn::Store(half_areas(x, y, z, edge), d, right_area[b]);
    }
    x = y = z = set_f8(kLowest);
    const auto all = hn::Set(di, static_cast<std::int32_t>(n));
    const auto rest = hn::Set(di, (1 << block_bits) - 1);
    const auto blocks = [&](auto items) HWY_ATTR {
        return hn::ConvertTo(d, hn::ShiftRightSame(hn::Add(items, rest), block_bits));
    };
    auto left = hn::Zero(di), best_bin = hn::Zero(di);
    auto best = hn::Set(d, std::numeric_limits<float>::infinity());
    for (int b = 1; b < binning.n_bins; ++b) {
        grow(bins[b - 1]);
        left =
            hn::Add(left, hn::Load(di, reinterpret_cast<const std::int32_t*>(bins[b - 1].count)));
        const auto right = hn::Sub(all, left);
        const auto cost = hn::Add(hn::Mul(half_areas(x, y, z, edge), blocks(left)),
                                  hn::Mul(hn::Load(d, right_area[b]), blocks(right)));
        const auto parts = hn::And(hn::Gt(left, hn::Zero(di)), hn::Gt(right, hn::Zero(di)));
        const auto better = hn::And(hn::Lt(cost, best), hn::RebindMask(d, parts));
        best = hn::IfThenElse(better, cost, best);
        best_bin = hn::IfThenElse(hn::RebindMask(di, better), hn::Set(di, b), best_bin);
    }
    alignas(16) float cost[4];
    alignas(16) std::int32_t bin[4];
    hn::Store(best, d, cost);
    hn::Store(best_bin, di, bin);
    Plane plane;
    for (int axis = 0; axis < 3; ++axis)
        if (cost[axis] < plane.cost)
            plane = {axis, bin[axis], cost[axis]};
    return plane;
}

#else

HWY_INLINE Plane cheapest_plane(const Bin* bins, const Binning& binning, std::uint32_t n,
                                int block_bits) {
    const auto blocks = [&](std::uint32_t items) {
        return static_cast<float>((items + (1u << block_bits) - 1) >> block_bits);
    };
    const float edge = binning.edge;
    const auto half_area = [edge](const F8& box) {
        alignas(32) float v[8];
        store_f8(box, v);
        const float x = v[0] + v[4] + edge, y = v[1] + v[5] + edge, z = v[2] + v[6] + edge;
        return x * y + z * (x + y);
    };
    Plane plane;
    for (int axis = 0; axis < 3; ++axis) {
        float right_area[kMaxBins];
        F8 side = set_f8(kLowest);
        for (int b = binning.n_bins; --b > 0;) {
            side = max_f8(side, load_f8(bins[b].box[axis]));
            right_area[b] = half_area(side);
        }
        side = set_f8(kLowest);
        std::uint32_t left = 0;
        for (int b = 1; b < binning.n_bins; ++b) {
            side = max_f8(side, load_f8(bins[b - 1].box[axis]));
            left += bins[b - 1].count[axis];
            const float cost = half_area(side) * blocks(left) + right_area[b] * blocks(n - left);
            if (left > 0 && left < n && cost < plane.cost)
                plane = {axis, b, cost};
        }
    }
    return plane;
}

#endif

/// Copies the items to `to`, those that go left from `left` on and the others from `right` on, each
/// in their old order, and grows the bounds of the doubled centres of each side. Without a branch,
/// which would be mispredicted half the time.
HWY_INLINE void partition(const Prim8* prims, std::size_t n, const Binning& binning, Plane plane,
                          Prim8* to, std::size_t left, std::size_t right, float (&left_centres)[8],
                          float (&right_centres)[8]) {
    F8 l = load_f8(left_centres), r = load_f8(right_centres);
    const float start = Binning::start(plane.bin);
    // One of the two places moves on at each step.
    const auto place = [&](std::size_t goes_left) {
        const std::size_t at = right ^ ((left ^ right) & (0 - goes_left));
        left += goes_left;
        right += 1 - goes_left;
        return to[at].v;
    };
#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
    namespace hn = hwy::HWY_NAMESPACE;
    constexpr F8Tag d;
    constexpr hn::FixedTag<std::int32_t, 8> di;
    const auto lane = hn::IndicesFromVec(d, hn::Set(di, plane.axis));
    const auto low = hn::Set(d, binning.low[plane.axis]),
               scale = hn::Set(d, binning.scale[plane.axis]), first = hn::Set(d, 1),
               starts = hn::Set(d, start), lowest = hn::Set(d, kLowest);
    for (std::size_t i = 0; i < n; ++i) {
        const F8 box = load_f8(prims[i].v);
        const F8 centre = doubled_centre(box);
        const auto x = hn::TableLookupLanes(centre.v, lane);
        const auto is_left = hn::Lt(hn::Add(hn::Mul(hn::Sub(x, low), scale), first), starts);
        l.v = hn::Max(l.v, hn::IfThenElse(is_left, centre.v, lowest));
        r.v = hn::Max(r.v, hn::IfThenElse(is_left, lowest, centre.v));
        store_f8(box, place(hn::CountTrue(d, is_left) >> 3));
    }
#else
    for (std::size_t i = 0; i < n; ++i) {
        const F8 box = load_f8(prims[i].v), centre = doubled_centre(box);
        const bool is_left =
            binning.position(prims[i].doubled_centre(plane.axis), plane.axis) < start;
        store_f8(box, place(is_left));
        F8& side = is_left ? l : r;
        side = max_f8(side, centre);
    }
#endif
    store_f8(l, left_centres);
    store_f8(r, right_centres);
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
