#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace boxwood {

/// A closed sphere of 2 * rings * rings triangles, with shared vertices.
inline TriangleMesh sphere(int rings) {
    TriangleMesh mesh;
    const double pi = std::acos(-1.0);
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < rings; ++j) {
            const double a = pi * i / rings, b = 2 * pi * j / rings;
            mesh.vertices.push_back({static_cast<float>(std::sin(a) * std::cos(b)),
                                     static_cast<float>(std::sin(a) * std::sin(b)),
                                     static_cast<float>(std::cos(a))});
        }
    const auto vertex = [&](int i, int j) {
        return static_cast<std::uint32_t>(i == 0       ? 0
                                          : i == rings ? rings * rings
                                                       : i * rings + j % rings);
    };
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < rings; ++j) {
            const std::uint32_t p = vertex(i, j), q = vertex(i, j + 1), r = vertex(i + 1, j),
                                s = vertex(i + 1, j + 1);
            if (i > 0)
                mesh.triangles.push_back({p, q, r});
            if (i < rings - 1)
                mesh.triangles.push_back({q, s, r});
        }
    return mesh;
}

/// Random rays, axis-parallel rays with +0 and -0, and rays along lattice planes and with ends.
inline std::vector<Ray<float>> test_rays() {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-2, 2);
    std::vector<Ray<float>> rays;
    for (int i = 0; i < 600; ++i) {
        const Vec3<float> from{place(random), place(random), place(random)};
        const Vec3<float> to{place(random) / 2, place(random) / 2, place(random) / 2};
        rays.push_back({from, to - from});
    }
    for (int i = 0; i < 120; ++i) {
        Ray<float> ray{{place(random) / 2, place(random) / 2, place(random) / 2},
                       {i & 1 ? 0.f : -0.f, i & 2 ? 0.f : -0.f, i & 4 ? 1.f : -1.f}};
        if (i % 3 == 0)
            std::swap(ray.direction.x, ray.direction.z);
        if (i % 5 == 0)
            ray.origin = {0, 0, 0};
        ray.t_max = i % 7 == 0 ? .5f : ray.t_max;
        ray.t_min = i % 11 == 0 ? .25f : 0;
        rays.push_back(ray);
    }
    return rays;
}

} // namespace boxwood
