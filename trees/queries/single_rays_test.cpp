#include "trees/layout.h"
#include "trees/queries/single_rays.h"

#include "kernels/registry.h"
#include "kernels/testing/closed_meshes.h"
#include "kernels/testing/every_target.h"
#include "trees/builder.h"
#include "trees/testing/brute_force_rays.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <thread>

namespace boxwood {
namespace {

using Point = Vec3<float>;

/// Each triangle twice: every hit is a tie.
TriangleMesh doubled(TriangleMesh mesh) {
    const auto all = mesh.triangles;
    mesh.triangles.insert(mesh.triangles.end(), all.rbegin(), all.rend());
    return mesh;
}

/// In all directions, with and without ends; then along axes, +0 and -0 components, within planes
/// of boxes; then what is not finite, and what overflows.
std::vector<Ray<float>> rays_of_all_kinds() {
    std::mt19937 random(22);
    std::uniform_real_distribution<float> place(-2, 2);
    std::vector<Ray<float>> rays;
    for (int i = 0; i < 800; ++i) {
        const Point from{place(random), place(random), place(random)};
        const Point to{place(random) / 2, place(random) / 2, place(random) / 2};
        Ray<float> ray{from, to - from};
        if (i % 4 == 1)
            ray.t_max = .4f + std::abs(place(random));
        if (i % 4 == 2)
            ray.t_min = std::abs(place(random));
        if (i % 16 == 3)
            ray.t_max = 0;
        rays.push_back(ray);
    }
    for (int i = 0; i < 120; ++i) {
        Ray<float> ray{{place(random) / 2, place(random) / 2, place(random) / 2},
                       {i & 1 ? 0.f : -0.f, i & 2 ? 0.f : -0.f, i & 4 ? 1.f : -1.f}};
        if (i % 3 == 0)
            std::swap(ray.direction.x, ray.direction.z);
        if (i % 3 == 1)
            std::swap(ray.direction.y, ray.direction.z);
        if (i % 5 == 0)
            ray.origin = {0, 0, 0};
        rays.push_back(ray);
    }
    const float nan = std::nanf(""), inf = INFINITY;
    for (const float bad : {nan, inf, -inf})
        for (int axis = 0; axis < 3; ++axis) {
            rays.push_back({{0, 0, 0}, {1, 1, 1}});
            rays.back().origin[axis] = bad;
            rays.push_back({{0, 0, 0}, {1, 1, 1}});
            rays.back().direction[axis] = bad;
        }
    rays.push_back({{0, 0, 0}, {1, 1, 1}, 0, nan});
    rays.push_back({{0, 0, 0}, {1, 1, 1}, 2, 1});
    rays.push_back({{0x1p127f, 0, 0}, {-1, 0, 0}});
    rays.push_back({{0, 0, 0}, {0x1p127f, 0x1p126f, 0x1p127f}});
    rays.push_back({{0, 0, 0}, {0x1p-140f, 0x1p-141f, 0x1p-140f}});
    return rays;
}

void expect_answers(const SingleRays& single, std::span<const Ray<float>> rays,
                    std::span<const RayHit> expected) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(single.closest(rays[i]), expected[i]) << i;
        ASSERT_EQ(single.any(rays[i]), expected[i].hit()) << i;
    }
}

TEST(SingleRays, AgreeWithBruteForceForEveryWayAndInstructionSet) {
    const std::vector<Ray<float>> rays = rays_of_all_kinds();
    for (const TriangleMesh& mesh :
         {uv_sphere(40, 20), triangle_soup(3000, 21), doubled(triangle_soup(300, 21)),
          triangle_soup(9, 21), triangle_soup(1, 21), TriangleMesh{}}) {
        const std::vector<RayHit> expected = brute_force<Watertight>(mesh, rays);
        const std::vector<Box> boxes = triangle_boxes(mesh);
        for (const char* builder : {"binned_sah", "ploc"})
            for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
                SCOPED_TRACE(std::string(builder) + "." + std::string(entry.name));
                const auto layout = entry.make(make_builder(builder)(boxes, serial()), serial());
                const TriangleBlocks triangles = layout->triangles(mesh);
                on_every_target([&] {
                    expect_answers(SingleRays(*layout, "watertight", triangles), rays, expected);
                });
            }
    }
}

TEST(SingleRays, AnswerAsABatchForEveryKernel) {
    const std::vector<Ray<float>> rays = rays_of_all_kinds();
    std::vector<RayHit> batch(rays.size());
    for (const TriangleMesh& mesh : {uv_sphere(40, 20), triangle_soup(3000, 21)}) {
        const Tree tree = make_builder("binned_sah")(triangle_boxes(mesh), serial());
        for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
            const auto layout = entry.make(tree, serial());
            const TriangleBlocks triangles = layout->triangles(mesh);
            for (const KernelInfo& kernel : ray_kernels()) {
                SCOPED_TRACE(std::string(entry.name) + " " + std::string(kernel.name));
                layout->rays(rays, RayQuery::closest, kernel.name, triangles, serial(), batch);
                expect_answers(SingleRays(*layout, kernel.name, triangles), rays, batch);
            }
        }
    }
}

TEST(SingleRays, AreAnsweredOnManyThreadsAtATime) {
    const TriangleMesh mesh = triangle_soup(2000, 21);
    const std::vector<Ray<float>> rays = rays_of_all_kinds();
    const std::vector<RayHit> expected = brute_force<Watertight>(mesh, rays);
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        const auto layout =
            entry.make(make_builder("median")(triangle_boxes(mesh), serial()), serial());
        const TriangleBlocks triangles = layout->triangles(mesh);
        const SingleRays single(*layout, "watertight", triangles);
        std::vector<std::vector<RayHit>> hits(4, std::vector<RayHit>(rays.size()));
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < hits.size(); ++t)
            threads.emplace_back([&, t] {
                for (std::size_t i = 0; i < rays.size(); ++i)
                    hits[t][i] = single.closest(rays[i]);
            });
        for (std::thread& thread : threads)
            thread.join();
        for (const std::vector<RayHit>& mine : hits)
            EXPECT_EQ(mine, expected) << entry.name;
    }
}

TEST(SingleRays, TraverseTreesThatAreTooDeepForTheirStack) {
    // A row of triangles along x, one split off after the other: as deep as a layout can be.
    constexpr std::uint32_t n = 2000;
    TriangleMesh mesh;
    Tree tree(n);
    for (std::uint32_t k = 0; k < n; ++k) {
        const auto x = static_cast<float>(k);
        mesh.vertices.insert(mesh.vertices.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 1}});
        mesh.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
        const Box rest{{x, 0, 0}, {n, 1, 1}}, own{{x, 0, 0}, {x + 1, 1, 1}};
        tree.order[k] = k;
        if (k + 1 < n)
            tree.nodes[2 * k] = {rest, k, n - k};
        tree.nodes[k + 1 < n ? 2 * k + 1 : 2 * k] = {own, k, 1};
    }
    std::vector<Ray<float>> rays{{{-1, .25f, .25f}, {1, 0, 0}}, {{n + 1, .25f, .25f}, {-1, 0, 0}}};
    for (std::uint32_t k = 0; k < n; k += 37)
        rays.push_back({{static_cast<float>(k) + .25f, .25f, -1}, {0, 0, 1}});
    const std::vector<RayHit> expected = brute_force<Watertight>(mesh, rays);
    EXPECT_TRUE(expected.back().hit());
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        SCOPED_TRACE(entry.name);
        const auto layout = entry.make(tree, serial());
        const TriangleBlocks triangles = layout->triangles(mesh);
        expect_answers(SingleRays(*layout, "watertight", triangles), rays, expected);
    }
    EXPECT_EQ(find_layout("wide8").make(tree, serial())->single_ray_functions("watertight").closest,
              nullptr);
}

TEST(SingleRays, HaveFunctionsOfTheirOwnForTheKernelsOfTheBench) {
    const TriangleMesh mesh = triangle_soup(100, 21);
    const Tree tree = make_builder("median")(triangle_boxes(mesh), serial());
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        const auto layout = entry.make(tree, serial());
        for (const char* kernel : {"moller_trumbore_f32", "moller_trumbore_f64", "watertight"}) {
            const SingleRayFunctions functions = layout->single_ray_functions(kernel);
            EXPECT_EQ(functions.closest != nullptr, !entry.name.starts_with("binary"))
                << entry.name;
            EXPECT_EQ(functions.any != nullptr, functions.closest != nullptr);
        }
    }
}

TEST(SingleRays, RefuseAnUnknownKernel) {
    const TriangleMesh mesh = triangle_soup(10, 21);
    const Tree tree = make_builder("median")(triangle_boxes(mesh), serial());
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        const auto layout = entry.make(tree, serial());
        EXPECT_THROW(SingleRays(*layout, "watertigth", layout->triangles(mesh)),
                     std::invalid_argument);
    }
}

} // namespace
} // namespace boxwood
