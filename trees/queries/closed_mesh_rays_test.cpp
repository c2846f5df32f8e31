#include "kernels/oracle/exact_answers.h"
#include "trees/testing/append_hits.h"
#include "trees/testing/each_builder.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

/// Points in line with edges and vertices of closed meshes, with faces that stand twice and faces
/// turned over. Boxwood has no query of containment; who counts hits for one needs all of them:
/// here the exact kernel's, of every layout, against rationals, and what they say of inside.
namespace boxwood {
namespace {

/// An octahedron with integer corners, each face cut at the middles of its edges.
TriangleMesh octahedron() {
    const Vec3<float> tips[]{{8, 0, 0}, {-8, 0, 0}, {0, 8, 0}, {0, -8, 0}, {0, 0, 8}, {0, 0, -8}};
    TriangleMesh mesh;
    const auto add = [&](Vec3<float> a, Vec3<float> b, Vec3<float> c) {
        const auto k = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
        mesh.triangles.push_back({k, k + 1, k + 2});
    };
    for (const int x : {0, 1})
        for (const int y : {2, 3})
            for (const int z : {4, 5}) {
                const Vec3<float> a = tips[x], b = tips[y], c = tips[z];
                const Vec3<float> ab = (a + b) * .5f, bc = (b + c) * .5f, ca = (c + a) * .5f;
                add(a, ab, ca);
                add(ab, b, bc);
                add(ca, bc, c);
                add(ab, bc, ca);
            }
    return mesh;
}

/// Some faces once more, and some of all turned over.
TriangleMesh spoilt(TriangleMesh mesh) {
    const std::size_t n = mesh.triangles.size();
    for (std::size_t i = 0; i < n; i += 3)
        mesh.triangles.push_back(mesh.triangles[i]);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 2)
        std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
    return mesh;
}

bool is_inside(Vec3<float> p) { return std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 8; }

/// From lattice points, none on the surface, to vertices and middles of edges and faces.
std::vector<Ray<float>> rays_at(const TriangleMesh& mesh) {
    std::mt19937 random(31);
    std::vector<Ray<float>> rays;
    for (const auto& t : mesh.triangles)
        for (int k = 0; k < 6; ++k) {
            const Vec3<float> a = mesh.vertices[t[0]], b = mesh.vertices[t[1]],
                              c = mesh.vertices[t[2]];
            const Vec3<float> to = k < 2 ? a : k < 4 ? (a + b) * .5f : (a + a + b + c) * .25f;
            Vec3<float> from;
            do
                for (int axis = 0; axis < 3; ++axis)
                    from[axis] = static_cast<float>(random() % 21) - 10;
            while (std::abs(from.x) + std::abs(from.y) + std::abs(from.z) == 8 || from == to);
            rays.push_back({from, to - from});
        }
    return rays;
}

TEST_P(EachBuilder, FindsEveryHitThroughEdgesAndVerticesOfClosedMeshes) {
    for (const TriangleMesh& mesh : {octahedron(), spoilt(octahedron())}) {
        const std::vector<Ray<float>> rays = rays_at(mesh);
        std::vector<Pair> expected;
        for (std::uint32_t r = 0; r < rays.size(); ++r)
            for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
                if (oracle::ray_triangle(rays[r], mesh.triangle(i)))
                    expected.push_back({r, i});
        const Tree tree = build(triangle_boxes(mesh));
        for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
            SCOPED_TRACE(entry.name);
            const auto layout = entry.make(tree, serial());
            AppendHits hits;
            layout->rays_all(rays, "exact", layout->triangles(mesh), serial(), hits);
            std::vector<Pair> found;
            // The convex surface is crossed at most twice, at distinct times: once from inside.
            std::vector<std::vector<float>> times(rays.size());
            for (const auto& [ray, hit] : hits.all) {
                found.push_back({ray, hit.triangle});
                if (times[ray].empty() || times[ray].back() != hit.t)
                    times[ray].push_back(hit.t);
            }
            std::ranges::sort(found);
            EXPECT_EQ(found, expected);
            for (std::size_t r = 0; r < rays.size(); ++r)
                if (is_inside(rays[r].origin)) {
                    EXPECT_EQ(times[r].size(), 1u) << r;
                } else {
                    EXPECT_LE(times[r].size(), 2u) << r;
                }
        }
    }
}

} // namespace
} // namespace boxwood
