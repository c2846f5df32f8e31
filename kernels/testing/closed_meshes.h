#pragma once

#include "kernels/primitives/triangle.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace boxwood {

/// The UV sphere of `slices` x `stacks` quads, each cut in two; the poles are fans. Every ray from
/// within hits it.
inline TriangleMesh uv_sphere(std::uint32_t slices, std::uint32_t stacks) {
    TriangleMesh mesh;
    constexpr double pi = std::numbers::pi;
    mesh.vertices = {{0, 0, 1}, {0, 0, -1}};
    for (std::uint32_t j = 1; j < stacks; ++j)
        for (std::uint32_t i = 0; i < slices; ++i) {
            const double a = pi * j / stacks, b = 2 * pi * i / slices;
            mesh.vertices.push_back(Vec3<float>(
                Vec3<double>{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)}));
        }
    const auto at = [&](std::uint32_t j, std::uint32_t i) {
        return 2 + (j - 1) * slices + i % slices;
    };
    for (std::uint32_t i = 0; i < slices; ++i) {
        mesh.triangles.push_back({0, at(1, i), at(1, i + 1)});
        mesh.triangles.push_back({1, at(stacks - 1, i + 1), at(stacks - 1, i)});
        for (std::uint32_t j = 1; j + 1 < stacks; ++j) {
            mesh.triangles.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
            mesh.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
        }
    }
    return mesh;
}

/// The closed box |x| <= 1, |y| <= 1, |z| <= half_length of 12 triangles; `turn` permutes the axes
/// cyclically. Its long triangles reach far behind most of the points where rays hit them.
inline TriangleMesh corridor(float half_length, int turn) {
    TriangleMesh mesh;
    for (std::uint32_t k = 0; k < 8; ++k) {
        Vec3<float> p{k & 1 ? 1.0f : -1.0f, k & 2 ? 1.0f : -1.0f,
                      k & 4 ? half_length : -half_length};
        for (int i = 0; i < turn; ++i)
            p = {p.y, p.z, p.x};
        mesh.vertices.push_back(p);
    }
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

inline std::vector<Triangle<float>> triangles_of(const TriangleMesh& mesh) {
    std::vector<Triangle<float>> triangles;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        triangles.push_back(mesh.triangle(i));
    return triangles;
}

/// Triangles around `tip`, narrowed in x; seen from far up z they cover a star around the tip.
struct Fan {
    std::vector<Vec3<float>> rim;
    Vec3<float> tip;
    std::vector<Triangle<float>> triangles;
};

/// needle: width against length.
template <class Random> Fan random_fan(Random& random, float needle) {
    using Point = Vec3<float>;
    std::uniform_real_distribution<float> wobble(.5f, 1.5f);
    std::uniform_real_distribution<float> place(-1, 1);
    Fan fan;
    const Point centre{2 * place(random), 2 * place(random), 2 * place(random)};
    const int n = 3 + static_cast<int>(random() % 10);
    for (int i = 0; i < n; ++i) {
        const float angle =
            2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(n);
        const float radius = wobble(random);
        fan.rim.push_back(centre + Point{needle * radius * std::cos(angle),
                                         radius * std::sin(angle), .2f * place(random)});
    }
    fan.tip =
        centre + Point{.1f * needle * place(random), .1f * place(random), .1f * place(random)};
    for (std::size_t i = 0; i < fan.rim.size(); ++i)
        fan.triangles.push_back({fan.tip, fan.rim[i], fan.rim[(i + 1) % fan.rim.size()]});
    return fan;
}

} // namespace boxwood
