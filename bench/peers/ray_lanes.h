#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// Which ray goes into which lane of packets, `width` lanes each: no_ray where none is left.
namespace boxwood::bench {

constexpr std::uint32_t no_ray = ~0u;

/// n rays as they come: only the last packet may have lanes without a ray.
inline std::vector<std::uint32_t> lanes_in_order(std::size_t n, std::size_t width) {
    std::vector<std::uint32_t> lanes((n + width - 1) / width * width, no_ray);
    for (std::size_t i = 0; i < n; ++i)
        lanes[i] = static_cast<std::uint32_t>(i);
    return lanes;
}

/// n rays that are a picture, row by row: a packet is a tile of 4 x width / 4 pixels, row by row.
/// Tiles at the right and at the bottom may reach beyond the picture.
inline std::vector<std::uint32_t> lanes_in_tiles(std::size_t n, std::size_t picture_width,
                                                 std::size_t width) {
    const std::size_t tile_width = 4, tile_height = width / tile_width;
    const std::size_t height = (n + picture_width - 1) / picture_width;
    std::vector<std::uint32_t> lanes;
    for (std::size_t top = 0; top < height; top += tile_height)
        for (std::size_t left = 0; left < picture_width; left += tile_width)
            for (std::size_t k = 0; k < width; ++k) {
                const std::size_t x = left + k % tile_width, y = top + k / tile_width;
                const std::size_t i = y * picture_width + x;
                lanes.push_back(x < picture_width && i < n ? static_cast<std::uint32_t>(i)
                                                           : no_ray);
            }
    return lanes;
}

} // namespace boxwood::bench
