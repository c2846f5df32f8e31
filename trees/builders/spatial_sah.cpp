#include "trees/builders/spatial_sah.h"

#include "trees/builders/binned_sah.h"
#include "trees/builders/detail/clip_triangle.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace boxwood {
using namespace detail;
namespace {

/// Worth cutting are boxes of triangles and of their parts of this many times the area that the
/// triangle or part hides along the axes, and of this many times an even share of the mesh's area.
/// By trial: cuts of fat triangles, and of those of smooth meshes, make rays slower.
constexpr double empty = 8, large = 8;

/// The cube around all triangles in cells of 2^-20 of its edge.
struct Grid {
    Vec3<float> low;
    double cell = 0;
    double min_area; ///< half area of boxes worth cutting

    Grid(const Box& bounds, std::size_t n)
        : low(bounds.min), min_area(large * bounds.half_area() / static_cast<double>(n)) {
        for (int k = 0; k < 3; ++k)
            cell = std::max(cell, static_cast<double>(bounds.max[k]) -
                                      static_cast<double>(bounds.min[k]));
        cell *= 0x1p-20;
    }
    std::uint32_t index(float x, int axis) const {
        return static_cast<std::uint32_t>(
            (static_cast<double>(x) - static_cast<double>(low[axis])) / cell);
    }
};

/// A plane across a box; no axis (-1) where none lies strictly within, or the box is too small.
struct Cut {
    int axis = -1;
    float plane = 0;
    int level = 0; ///< bits of the cells' indices below the plane: 19 halves the cube
};

/// The coarsest plane of the halved, quartered ... cube that crosses the box; of those of several
/// axes the one along which the box is longest. Cuts of neighbours so lie in the same planes.
Cut coarsest_cut(const Grid& grid, const Box& box) {
    Cut cut;
    if (!(box.half_area() > grid.min_area))
        return cut;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = grid.index(box.min[k], k), b = grid.index(box.max[k], k);
        if (a == b)
            continue;
        const int level = static_cast<int>(std::bit_width(a ^ b)) - 1;
        const auto plane = static_cast<float>(static_cast<double>(grid.low[k]) +
                                              grid.cell * static_cast<double>(b >> level << level));
        const bool better =
            cut.axis < 0 || level > cut.level ||
            (level == cut.level && box.max[k] - box.min[k] > box.max[cut.axis] - box.min[cut.axis]);
        if (better && plane > box.min[k] && plane < box.max[k])
            cut = {k, plane, level};
    }
    return cut;
}

/// How much a triangle is worth cutting, and the most cuts that are: a long one cut in k has boxes
/// that are k times less empty.
struct Worth {
    double value = 0;
    double max_cuts = 0;

    std::uint32_t cuts(double scale) const {
        return static_cast<std::uint32_t>(std::min(value * scale, max_cuts));
    }
};

constexpr std::uint32_t max_cuts = 63;

/// The value is what the box has more of than the triangle's own shadows along the axes, which cuts
/// do not lessen; doubled for each level that the first cut is coarser.
Worth worth(const Grid& grid, const Triangle<float>& t, const Box& box) {
    const Cut cut = coarsest_cut(grid, box);
    if (cut.axis < 0)
        return {};
    const Vec3<double> a(t.a), n = cross(Vec3<double>(t.b) - a, Vec3<double>(t.c) - a);
    const double shadows = .5 * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    const double max_value = box.half_area() / (empty * shadows);
    if (!(max_value >= 2))
        return {};
    return {std::cbrt(std::ldexp(box.half_area() - shadows, cut.level)),
            std::min(max_value - 1, static_cast<double>(max_cuts))};
}

constexpr std::size_t chunk = 4096;

constexpr std::size_t n_chunks(std::size_t n) { return (n + chunk - 1) / chunk; }

/// The boxes of a triangle's parts after up to `cuts` cuts, each of the part of the largest area.
std::size_t cut_up(const Grid& grid, const Triangle<float>& t, const Box& box, std::uint32_t cuts,
                   Box* parts) {
    parts[0] = box;
    if (cuts == 0)
        return 1;
    const ClippedTriangle clipped(t);
    std::size_t n = 1;
    for (std::uint32_t c = 0; c < cuts; ++c) {
        std::size_t largest = 0;
        for (std::size_t i = 1; i < n; ++i)
            if (parts[i].half_area() > parts[largest].half_area())
                largest = i;
        const Cut cut = coarsest_cut(grid, parts[largest]);
        if (cut.axis < 0)
            break;
        const auto [below, above] = clipped.parts(parts[largest], cut.axis, cut.plane);
        if (below.is_empty() || above.is_empty()) {
            if (const Box& rest = below.is_empty() ? above : below; !rest.is_empty())
                parts[largest] = rest;
            continue;
        }
        parts[largest] = below;
        parts[n++] = above;
    }
    return n;
}

/// Bounds that show a NaN among the corners, which bounds() leaves out.
Box bounds_with_nan(const Triangle<float>& t) {
    const bool finite = is_finite(t.a) && is_finite(t.b) && is_finite(t.c);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    return finite ? t.bounds() : Box{{nan, nan, nan}, {nan, nan, nan}};
}

/// Calls f(chunk, begin, end) for the triangles in chunks.
template <class F> void for_chunks(std::size_t n, const Executor& executor, const F& f) {
    executor.for_each(n_chunks(n),
                      [&](std::size_t c) { f(c, c * chunk, std::min(n, (c + 1) * chunk)); });
}

/// The factor from worth to cuts that spends the spare leaves: the largest of a bisection that does
/// not overspend.
double scale_for(std::span<const Worth> worths, double spare, const Executor& executor) {
    double max_value = 0;
    for (const Worth& w : worths)
        max_value = std::max(max_value, w.value);
    if (!(max_value > 0))
        return 0;
    const auto spent = [&](double scale) {
        std::vector<std::size_t> sums(n_chunks(worths.size()), 0);
        for_chunks(worths.size(), executor, [&](std::size_t c, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                sums[c] += worths[i].cuts(scale);
        });
        return static_cast<double>(std::accumulate(sums.begin(), sums.end(), std::size_t{0}));
    };
    // All that is worth it, if the leaves suffice.
    if (constexpr double all = std::numeric_limits<double>::max(); spent(all) <= spare)
        return all;
    // In octaves from where the first triangle is cut, then in fractions of one.
    double scale = 1 / max_value;
    for (int octave = 0; octave < 64 && spent(2 * scale) <= spare; ++octave)
        scale *= 2;
    for (double step = scale / 2; step > scale * 0x1p-10; step /= 2)
        if (spent(scale + step) <= spare)
            scale += step;
    return scale;
}

} // namespace

Tree SpatialSahBuilder::build(Boxes boxes, const Executor& executor) const {
    BinnedSahBuilder binned;
    binned.agglomerate_below = binned.leaf_size = 8;
    return binned.build(boxes, executor);
}

Tree SpatialSahBuilder::build_of_mesh(const TriangleMesh& mesh, const Executor& executor) const {
    const std::size_t n = mesh.triangles.size();
    std::vector<Box> boxes(n);
    for_chunks(n, executor, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            boxes[i] = bounds_with_nan(mesh.triangle(i));
    });
    require_valid(boxes);
    Box bounds;
    for (const Box& box : boxes)
        bounds.extend(box);
    const Grid grid(bounds, n);
    const double spare = std::floor((references - 1) * static_cast<double>(n));

    Tree tree;
    if (n == 0 || spare < 1 || !(grid.cell > 0)) {
        tree = build(boxes, executor);
        tree.is_split = true;
        return tree;
    }
    std::vector<Worth> worths(n);
    for_chunks(n, executor, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            worths[i] = worth(grid, mesh.triangle(i), boxes[i]);
    });
    const double scale = scale_for(worths, spare, executor);

    struct Parts {
        std::vector<Box> boxes;
        std::vector<std::uint32_t> items;
    };
    std::vector<Parts> of_chunk(n_chunks(n));
    for_chunks(n, executor, [&](std::size_t c, std::size_t begin, std::size_t end) {
        Parts& parts = of_chunk[c];
        Box cut[max_cuts + 1];
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t cuts = worths[i].cuts(scale);
            const std::size_t m = cut_up(grid, mesh.triangle(i), boxes[i], cuts, cut);
            parts.boxes.insert(parts.boxes.end(), cut, cut + m);
            parts.items.insert(parts.items.end(), m, static_cast<std::uint32_t>(i));
        }
    });
    Parts all;
    for (const Parts& parts : of_chunk) {
        all.boxes.insert(all.boxes.end(), parts.boxes.begin(), parts.boxes.end());
        all.items.insert(all.items.end(), parts.items.begin(), parts.items.end());
    }
    tree = build(all.boxes, executor);
    for (std::uint32_t& item : tree.order)
        item = all.items[item];
    tree.is_split = true;
    return tree;
}

BuilderEntry spatial_sah_builder() { return builder_entry<SpatialSahBuilder>(); }

} // namespace boxwood
