#include "trees/builders/binned_sah.h"
#include "trees/builders/top_down.h"

#include <limits>

namespace boxwood {
namespace {

/// x, y, z and a lane to spare: one register on every 64-bit machine (GCC and Clang vector types).
/// The spare lane of a Prim is not a coordinate. It takes part in minima; for arithmetic it is
/// cleared, for read as a float it may be a denormal, which is slow, or NaN.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

Float4 load(const float* p) { return *reinterpret_cast<const Float4*>(p); }
Float4 min4(Float4 a, Float4 b) { return a < b ? a : b; }
Float4 max4(Float4 a, Float4 b) { return a > b ? a : b; }
Float4 splat(float x) { return Float4{x, x, x, x}; }
Float4 centre(const Prim& p) {
    const Float4 sum = load(&p.min.x) * .5f + load(&p.max.x) * .5f;
    return reinterpret_cast<Float4>(reinterpret_cast<Int4>(sum) & Int4{-1, -1, -1, 0});
}

struct Bin {
    Float4 min, max;
    std::uint32_t count;

    void clear() {
        constexpr float inf = std::numeric_limits<float>::infinity();
        min = Float4{inf, inf, inf, inf};
        max = -min;
        count = 0;
    }
    void add(Float4 lo, Float4 hi) {
        min = min4(lo, min);
        max = max4(hi, max);
        ++count;
    }
    void add(const Bin& other) {
        min = min4(other.min, min);
        max = max4(other.max, max);
        count += other.count;
    }
    /// Items times half area. For an empty bin it means nothing.
    double cost() const {
        const Float4 d = max - min;
        const double x = static_cast<double>(d[0]), y = static_cast<double>(d[1]),
                     z = static_cast<double>(d[2]);
        return static_cast<double>(count) * (x * y + y * z + z * x);
    }
};

/// Which bin the centre of a box falls in, on each axis. Clamped even where rounding "cannot" leave
/// the range; a NaN from 0 * inf (a denormal spread) goes to bin 0.
struct Binning {
    Float4 low, scale, last;
    Int4 operator()(const Prim& p) const {
        const Float4 x = (centre(p) - low) * scale;
        return __builtin_convertvector(min4(max4(x, splat(0)), last), Int4);
    }
};

struct Plane {
    int axis = -1, bin = 0;
};

/// The cheapest plane between bins. Equal costs (points on a line have no area at all) go to the
/// more even split; no plane (axis -1) if on every axis all items fall in one bin.
Plane cheapest_plane(const Bin (&bins)[BinnedSahBuilder::most_bins][3], int n_bins,
                     std::uint32_t n) {
    Plane best;
    double best_cost = std::numeric_limits<double>::infinity();
    std::uint32_t best_larger = n;
    for (int axis = 0; axis < 3; ++axis) {
        double right_cost[BinnedSahBuilder::most_bins];
        Bin side;
        side.clear();
        for (int b = n_bins; --b > 0;) {
            side.add(bins[b][axis]);
            right_cost[b] = side.cost();
        }
        side.clear();
        for (int b = 1; b < n_bins; ++b) {
            side.add(bins[b - 1][axis]);
            if (side.count == 0 || side.count == n)
                continue;
            const double cost = side.cost() + right_cost[b];
            const std::uint32_t larger = std::max(side.count, n - side.count);
            if (cost < best_cost || (cost == best_cost && larger < best_larger)) {
                best = {axis, b};
                best_cost = cost;
                best_larger = larger;
            }
        }
    }
    return best;
}

std::size_t split_binned(std::span<Prim> prims, std::span<Prim> scratch, int most_bins) {
    Float4 low = centre(prims[0]), high = low;
    for (const Prim& p : prims) {
        const Float4 c = centre(p);
        low = min4(c, low);
        high = max4(c, high);
    }
    const int n_bins = static_cast<int>(
        std::min<std::size_t>(static_cast<std::size_t>(most_bins), 4 + prims.size() / 16));
    const Float4 spread = high - low;
    const Binning bin_of{low, splat(static_cast<float>(n_bins)) / max4(spread, splat(0)),
                         splat(static_cast<float>(n_bins - 1))};
    Bin bins[BinnedSahBuilder::most_bins][3];
    for (int b = 0; b < n_bins; ++b)
        for (Bin& bin : bins[b])
            bin.clear();
    for (const Prim& p : prims) {
        const Float4 lo = load(&p.min.x), hi = load(&p.max.x);
        const Int4 bin = bin_of(p);
        bins[bin[0]][0].add(lo, hi);
        bins[bin[1]][1].add(lo, hi);
        bins[bin[2]][2].add(lo, hi);
    }

    const Plane plane = cheapest_plane(bins, n_bins, static_cast<std::uint32_t>(prims.size()));
    if (plane.axis < 0)
        return split_median(prims);
    // Both sides in their old order and without a branch, which would be mispredicted half the
    // time: what goes left moves up in place, what goes right is put aside.
    std::size_t n_left = 0, n_right = 0;
    for (const Prim& each : prims) {
        const Prim p = each;
        const bool is_left = bin_of(p)[plane.axis] < plane.bin;
        prims[n_left] = p;
        scratch[n_right] = p;
        n_left += is_left;
        n_right += !is_left;
    }
    std::copy_n(scratch.begin(), n_right, prims.begin() + static_cast<std::ptrdiff_t>(n_left));
    return n_left;
}

} // namespace

Tree BinnedSahBuilder::build(Boxes boxes, const Executor& executor) const {
    const int most = static_cast<int>(bins);
    return build_top_down(boxes, executor, [most](std::span<Prim> prims, std::span<Prim> scratch) {
        return split_binned(prims, scratch, most);
    });
}

BuilderEntry binned_sah_builder() { return builder_entry<BinnedSahBuilder>(); }

} // namespace boxwood
