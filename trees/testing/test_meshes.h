#pragma once

#include "kernels/primitives/triangle.h"
#include "trees/world/box_mesh.h"
#include "trees/world/pose.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace boxwood {

/// A closed sphere of `rings` x `segments` quads whose radius varies by up to `noise` of it.
inline TriangleMesh noisy_sphere(std::uint32_t rings, std::uint32_t segments, double noise,
                                 std::uint32_t seed, double radius = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> part(-noise, noise);
    TriangleMesh mesh;
    const double pi = std::acos(-1.0);
    for (std::uint32_t i = 0; i <= rings; ++i)
        for (std::uint32_t j = 0; j < segments; ++j) {
            const bool pole = i == 0 || i == rings;
            const double a = pi * i / rings, b = 2 * pi * j / segments;
            const double r = pole ? radius : radius * (1 + part(random)),
                         s = pole ? 0 : r * std::sin(a);
            mesh.vertices.push_back(
                Vec3<float>(Vec3<double>{s * std::cos(b), s * std::sin(b), r * std::cos(a)}));
        }
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < segments; ++j) {
            const std::uint32_t a = i * segments + j, b = i * segments + (j + 1) % segments;
            const std::uint32_t c = a + segments, d = b + segments;
            if (i > 0)
                mesh.triangles.push_back({a, c, b});
            if (i + 1 < rings)
                mesh.triangles.push_back({b, c, d});
        }
    return mesh;
}

/// n x n quads over the unit square at height z, plus a wave of that height.
inline TriangleMesh plate(std::uint32_t n, double z, double wave = 0) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j)
            mesh.vertices.push_back(Vec3<float>(
                Vec3<double>{static_cast<double>(i) / n, static_cast<double>(j) / n,
                             z + wave * std::sin(9.0 * i / n) * std::cos(7.0 * j / n)}));
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t q = i * (n + 1) + j;
            mesh.triangles.push_back({q, q + 1, q + n + 2});
            mesh.triangles.push_back({q, q + n + 2, q + n + 1});
        }
    return mesh;
}

/// An axis-aligned cube about a centre, of 12 triangles.
inline TriangleMesh cube_mesh(float half, Vec3<float> centre = {}) {
    TriangleMesh mesh = box_mesh(2 * double{half} * Vec3<double>{1, 1, 1});
    for (Vec3<float>& v : mesh.vertices)
        v = centre + v;
    return mesh;
}

inline TriangleMesh one_triangle(const Vec3<float>& a, const Vec3<float>& b, const Vec3<float>& c) {
    return {{a, b, c}, {{0, 1, 2}}};
}

/// Any rotation, at a place.
inline Pose random_pose(std::mt19937& random, Vec3<double> at) {
    std::normal_distribution<double> normal;
    std::array<double, 4> q;
    double squared = 0;
    for (double& x : q) {
        x = normal(random);
        squared += x * x;
    }
    const double s = 2 / squared;
    const auto [w, x, y, z] = q;
    Pose pose;
    pose.rotation = {{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                      {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
                      {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
    pose.translation = at;
    return checked_pose(pose);
}

inline Triangle<double> triangle_at(const TriangleMesh& mesh, std::size_t i,
                                    const Pose& pose = {}) {
    const Triangle<float> t = mesh.triangle(i);
    return {pose(Vec3<double>(t.a)), pose(Vec3<double>(t.b)), pose(Vec3<double>(t.c))};
}

} // namespace boxwood
