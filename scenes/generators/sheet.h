#pragma once

#include "kernels/primitives/triangle.h"

#include <cstddef>
#include <cstdint>

namespace boxwood {

inline constexpr double sheet_width = 3; ///< from -1.5 to 1.5 in x and y

/// The most squares of two triangles along a side with n triangles in all, one at least.
inline std::uint32_t squares_per_side(std::size_t n) {
    std::uint32_t m = 1;
    while (2 * std::uint64_t{m + 1} * (m + 1) <= n)
        ++m;
    return m;
}

/// A square sheet of m x m squares, two triangles each, their diagonals by turns; height(x, y): z.
template <class Height> TriangleMesh sheet(std::uint32_t m, const Height& height) {
    TriangleMesh mesh;
    const double step = sheet_width / m;
    for (std::uint32_t y = 0; y <= m; ++y)
        for (std::uint32_t x = 0; x <= m; ++x) {
            const double px = x * step - sheet_width / 2, py = y * step - sheet_width / 2;
            mesh.vertices.push_back({static_cast<float>(px), static_cast<float>(py),
                                     static_cast<float>(height(px, py))});
        }
    for (std::uint32_t y = 0; y < m; ++y)
        for (std::uint32_t x = 0; x < m; ++x) {
            const std::uint32_t a = y * (m + 1) + x, b = a + 1, c = a + m + 1, d = c + 1;
            if ((x + y) % 2 == 0)
                mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {a, d, c}});
            else
                mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {b, d, c}});
        }
    return mesh;
}

} // namespace boxwood
