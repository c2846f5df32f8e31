#include "trees/builders/binned_sah.h"
#include "trees/builders/top_down.h"

#include <limits>

namespace boxwood {
namespace {

/// x, y, z and a lane to spare: one register on every 64-bit machine (GCC and Clang vector type).
/// The spare lane of a Prim is not a coordinate; it takes part in minima alone, never in
/// arithmetic.
using Float4 = float __attribute__((vector_size(16)));
Float4 load(const float* p) { return *reinterpret_cast<const Float4*>(p); }
Float4 min4(Float4 a, Float4 b) { return a < b ? a : b; }
Float4 max4(Float4 a, Float4 b) { return a > b ? a : b; }

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
    /// In double: no overflow for finite boxes. 0 for an empty bin.
    double cost() const {
        const Box box{{min[0], min[1], min[2]}, {max[0], max[1], max[2]}};
        return static_cast<double>(count) * box.half_area();
    }
};

/// Which bin a centre falls in. Clamped even where rounding "cannot" leave the range, and a NaN
/// from 0 * inf (a denormal spread) goes to bin 0.
struct Binning {
    float low, scale, last;
    int operator()(float centre) const {
        const float x = (centre - low) * scale;
        return static_cast<int>(x > 0 ? (x < last ? x : last) : 0);
    }
};

std::size_t split_binned(std::span<Prim> prims, int most_bins) {
    Box centres;
    for (const Prim& p : prims)
        centres.extend(Vec3<float>{p.centre(0), p.centre(1), p.centre(2)});
    const Vec3<float> low = centres.min, spread = centres.max - centres.min;
    if (spread == Vec3<float>{})
        return split_median(prims);

    const int n_bins = static_cast<int>(
        std::min<std::size_t>(static_cast<std::size_t>(most_bins), 4 + prims.size() / 16));
    Binning binning[3];
    Bin bins[3][BinnedSahBuilder::most_bins];
    for (int axis = 0; axis < 3; ++axis) {
        const float scale = spread[axis] > 0 ? static_cast<float>(n_bins) / spread[axis] : 0;
        binning[axis] = {low[axis], scale, static_cast<float>(n_bins - 1)};
        for (int b = 0; b < n_bins; ++b)
            bins[axis][b].clear();
    }
    for (const Prim& p : prims) {
        const Float4 lo = load(&p.min.x), hi = load(&p.max.x);
        for (int axis = 0; axis < 3; ++axis)
            bins[axis][binning[axis](p.centre(axis))].add(lo, hi);
    }

    // Equal costs (points on a line have no area at all) go to the more even split.
    double best = std::numeric_limits<double>::infinity();
    std::uint32_t best_larger = 0;
    int best_axis = -1, best_bin = 0;
    const auto n = static_cast<std::uint32_t>(prims.size());
    for (int axis = 0; axis < 3; ++axis) {
        if (!(spread[axis] > 0))
            continue;
        double right_cost[BinnedSahBuilder::most_bins];
        Bin side;
        side.clear();
        for (int b = n_bins; --b > 0;) {
            side.add(bins[axis][b]);
            right_cost[b] = side.count ? side.cost() : -1;
        }
        side.clear();
        for (int b = 1; b < n_bins; ++b) {
            side.add(bins[axis][b - 1]);
            if (side.count == 0 || right_cost[b] < 0)
                continue;
            const double cost = side.cost() + right_cost[b];
            const std::uint32_t larger = std::max(side.count, n - side.count);
            if (cost < best || (cost == best && larger < best_larger)) {
                best = cost;
                best_larger = larger;
                best_axis = axis;
                best_bin = b;
            }
        }
    }
    if (best_axis < 0)
        return split_median(prims);
    const Binning& bin = binning[best_axis];
    const auto middle = std::partition(prims.begin(), prims.end(), [&](const Prim& p) {
        return bin(p.centre(best_axis)) < best_bin;
    });
    return static_cast<std::size_t>(middle - prims.begin());
}

} // namespace

Tree BinnedSahBuilder::build(Boxes boxes, const Executor& executor) const {
    const int most = static_cast<int>(bins);
    return build_top_down(boxes, executor,
                          [most](std::span<Prim> prims) { return split_binned(prims, most); });
}

BuilderEntry binned_sah_builder() { return builder_entry<BinnedSahBuilder>(); }

} // namespace boxwood
