#include "trees/queries/tiled_rays.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

namespace boxwood {
namespace {

constexpr std::size_t side = 4, tiles_in_chunk = 32, chunk = tiles_in_chunk * side * side;

} // namespace

void tiled_rays(const AnyLayout& layout, std::span<const Ray<float>> rays, std::size_t width,
                RayQuery query, std::string_view kernel, const TriangleBlocks& triangles,
                const Executor& executor, std::span<RayHit> hits) {
    if (hits.size() != rays.size())
        throw std::invalid_argument("rays: one hit per ray is wanted");
    if (width == 0)
        throw std::invalid_argument("tiled_rays: a picture needs a width");
    layout.rays({}, query, kernel, triangles, serial(), {}); // refuses an unknown kernel
    width = std::min(width, std::max<std::size_t>(rays.size(), 1));
    const std::size_t height = (rays.size() + width - 1) / width;
    const std::size_t across = (width + side - 1) / side, down = (height + side - 1) / side;
    const std::size_t tiles = across * down;
    executor.for_each((tiles + tiles_in_chunk - 1) / tiles_in_chunk, [&](std::size_t c) {
        constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
        std::array<Ray<float>, chunk> ray;
        std::array<RayHit, chunk> hit;
        std::array<std::size_t, chunk> from;
        std::size_t n = 0;
        const std::size_t end = std::min(tiles, (c + 1) * tiles_in_chunk);
        for (std::size_t tile = c * tiles_in_chunk; tile < end; ++tile) {
            const std::size_t left = tile % across * side, top = tile / across * side;
            const std::size_t corner = top * width + left;
            if (corner >= rays.size())
                continue;
            for (std::size_t y = top; y < top + side; ++y)
                for (std::size_t x = left; x < left + side; ++x, ++n) {
                    const std::size_t i = y * width + x;
                    const bool is_there = x < width && i < rays.size();
                    from[n] = is_there ? i : none;
                    ray[n] = rays[is_there ? i : corner];
                    if (!is_there)
                        ray[n].t_max = -1; // ends before it begins
                }
        }
        layout.rays(std::span(ray).first(n), query, kernel, triangles, serial(),
                    std::span(hit).first(n));
        for (std::size_t i = 0; i < n; ++i)
            if (from[i] != none)
                hits[from[i]] = hit[i];
    });
}

} // namespace boxwood
