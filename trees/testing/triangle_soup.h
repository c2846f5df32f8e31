#pragma once

#include "kernels/primitives/triangle.h"
#include "trees/tree.h"

#include <cstdint>
#include <random>
#include <vector>

namespace boxwood {

/// n small triangles, no corner shared, about the cube from -1 to 1.
inline TriangleMesh triangle_soup(std::uint32_t n, std::uint32_t seed = 5) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-1, 1), extent(-.1f, .1f);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Vec3<float> p{place(random), place(random), place(random)};
        for (int k = 0; k < 3; ++k)
            mesh.vertices.push_back(p +
                                    Vec3<float>{extent(random), extent(random), extent(random)});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

inline std::vector<Box> triangle_boxes(const TriangleMesh& mesh) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        boxes.push_back(mesh.triangle(i).bounds());
    return boxes;
}

} // namespace boxwood
