#include "trees/queries/sorted_rays.h"

#include "trees/ordering/detail/code_records.h"
#include "trees/ordering/ray_codes.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace boxwood {
using namespace detail;
namespace {

constexpr std::size_t window = std::size_t{1} << 24, chunk = 512;

/// What is sorted: the code above the ray.
Buffer<std::uint64_t> sorted_records(std::span<const Ray<float>> rays, const Box& bounds,
                                     const Executor& executor) {
    return code_records(
        rays.size(), 3 * EntryGrid::bits + 3, executor,
        [&, grid = EntryGrid(bounds)](std::size_t i) { return grid.code(rays[i]); });
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
