#include "trees/queries/sorted_rays.h"

#include "trees/executors/chunks.h"
#include "trees/ordering/detail/radix_sort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>

namespace boxwood {
using namespace detail;
namespace {

constexpr int bits = 7; ///< per axis: with the octant three digits of radix_sort
constexpr std::size_t window = std::size_t{1} << 24, chunk = 512;

template <class F> void for_parts(std::size_t n, const Executor& executor, const F& f) {
    const std::size_t parts = chunks_for(n, executor);
    executor.for_each(parts, [&](std::size_t p) {
        const ChunkRange range(n, parts, p);
        f(range.begin, range.end);
    });
}

/// Bit i of a cell's number goes to bit 3 i.
constexpr std::uint32_t spread(std::uint32_t cell) {
    cell = (cell | cell << 8) & 0x0000f00fu;
    cell = (cell | cell << 4) & 0x000c30c3u;
    return (cell | cell << 2) & 0x00249249u;
}
static_assert(spread(0x7f) == 0x49249 && spread(0x50) == 0x41000);

/// Cells of the cube around a box.
class EntryGrid {
  public:
    explicit EntryGrid(const Box& bounds)
        : plane_{{{bounds.min.x, bounds.min.y, bounds.min.z},
                  {bounds.max.x, bounds.max.y, bounds.max.z}}} {
        const Vec3<double> extent = Vec3<double>(bounds.max) - Vec3<double>(bounds.min);
        const double side = std::max({extent.x, extent.y, extent.z});
        scale_ = side > 0 ? static_cast<float>((1 << bits) / side) : 0;
    }

    /// The octant above the place of entry. Any ray has a code: one that passes by, and whatever is
    /// not a number or overflows, gets that of some cell.
    std::uint32_t code(const Ray<float>& ray) const {
        float t = ray.t_min;
        const std::uint32_t octant = enter<0>(ray.origin.x, ray.direction.x, t) |
                                     enter<1>(ray.origin.y, ray.direction.y, t) |
                                     enter<2>(ray.origin.z, ray.direction.z, t);
        const std::uint32_t curve = cell<0>(ray.origin.x + t * ray.direction.x) |
                                    cell<1>(ray.origin.y + t * ray.direction.y) |
                                    cell<2>(ray.origin.z + t * ray.direction.z);
        return octant << 3 * bits | curve;
    }

  private:
    /// The ray is not within the bounds before this t; gives its bit of the octant.
    template <int axis> std::uint32_t enter(float origin, float direction, float& t) const {
        const std::uint32_t sign = std::bit_cast<std::uint32_t>(direction) >> 31;
        t = std::max(t, (plane_[sign][axis] - origin) / direction);
        return sign << axis;
    }
    template <int axis> std::uint32_t cell(float place) const {
        const float at = (place - plane_[0][axis]) * scale_;
        return spread(static_cast<std::uint32_t>(std::min(std::max(first_, at), last_))) << axis;
    }

    std::array<std::array<float, 3>, 2> plane_; ///< least, greatest
    float scale_;
    /// Cells along an axis; constants would be taken for cases apart, whose branches are
    /// mispredicted.
    float first_ = 0, last_ = (1 << bits) - 1;
};

/// What is sorted: the code above the ray.
Buffer<std::uint64_t> sorted_records(std::span<const Ray<float>> rays, const Box& bounds,
                                     const Executor& executor) {
    const EntryGrid grid(bounds);
    Buffer<std::uint64_t> records(rays.size()), spare(rays.size());
    for_parts(rays.size(), executor, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            records[i] = std::uint64_t{grid.code(rays[i])} << 32 | i;
    });
    radix_sort(records, spare, 32, 32 + 3 * bits + 3, executor);
    return records;
}

} // namespace

Buffer<std::uint32_t> ray_order(std::span<const Ray<float>> rays, const Box& bounds,
                                const Executor& executor) {
    const Buffer<std::uint64_t> records = sorted_records(rays, bounds, executor);
    Buffer<std::uint32_t> order(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        order[i] = static_cast<std::uint32_t>(records[i]);
    return order;
}

void sorted_rays(const AnyLayout& layout, std::span<const Ray<float>> rays, RayQuery query,
                 std::string_view kernel, const TriangleBlocks& triangles, const Executor& executor,
                 std::span<RayHit> hits) {
    if (hits.size() != rays.size())
        throw std::invalid_argument("rays: one hit per ray is wanted");
    layout.rays({}, query, kernel, triangles, serial(), {}); // refuses an unknown kernel
    for (std::size_t first = 0; first < rays.size(); first += window) {
        const auto some = rays.subspan(first, std::min(window, rays.size() - first));
        const auto answers = hits.subspan(first, some.size());
        const Buffer<std::uint64_t> records = sorted_records(some, triangles.bounds, executor);
        executor.for_each((some.size() + chunk - 1) / chunk, [&](std::size_t c) {
            std::array<Ray<float>, chunk> ray;
            std::array<RayHit, chunk> hit;
            const std::uint64_t* const record = records.data() + c * chunk;
            const std::size_t n = std::min(chunk, some.size() - c * chunk);
            for (std::size_t i = 0; i < n; ++i)
                ray[i] = some[static_cast<std::uint32_t>(record[i])];
            layout.rays(std::span(ray).first(n), query, kernel, triangles, serial(),
                        std::span(hit).first(n));
            for (std::size_t i = 0; i < n; ++i)
                answers[static_cast<std::uint32_t>(record[i])] = hit[i];
        });
    }
}

} // namespace boxwood
