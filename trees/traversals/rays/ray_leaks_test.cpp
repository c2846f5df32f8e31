#include "kernels/registry.h"
#include "kernels/testing/closed_meshes.h"
#include "kernels/testing/every_target.h"
#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/queries/single_rays.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

namespace boxwood {
namespace {

using Point = Vec3<float>;

/// Rays per kernel and layout; BOXWOOD_LEAK_RAYS=10000000 is the count of the README's claim.
std::size_t n_rays() {
    const char* wanted = std::getenv("BOXWOOD_LEAK_RAYS");
    return wanted ? std::stoul(wanted) : 100000;
}

std::unique_ptr<AnyLayout> layout_of(const TriangleMesh& mesh, const LayoutEntry& entry) {
    return entry.make(make_builder("binned_sah")(triangle_boxes(mesh), serial()), serial());
}

/// Rays from within a mesh that hit nothing, closest and any together, in a batch and alone.
std::size_t leaks(const AnyLayout& layout, const TriangleMesh& mesh, std::string_view kernel,
                  std::span<const Ray<float>> rays) {
    const TriangleBlocks triangles = layout.triangles(mesh);
    std::vector<RayHit> hits(rays.size());
    std::size_t n = 0;
    for (const RayQuery query : {RayQuery::closest, RayQuery::any}) {
        layout.rays(rays, query, kernel, triangles, serial(), hits);
        n += hits.size() - static_cast<std::size_t>(std::ranges::count_if(hits, &RayHit::hit));
    }
    const SingleRays single(layout, kernel, triangles);
    for (const Ray<float>& ray : rays)
        n += std::size_t{!single.closest(ray).hit()} + std::size_t{!single.any(ray)};
    return n;
}

class CountHits final : public HitSink {
  public:
    void begin(std::size_t, bool) override {}
    bool take(std::size_t, std::uint32_t, std::span<const RayHit> hits) override {
        n += hits.size();
        return true;
    }
    void end() override {}
    std::size_t n = 0;
};

/// Calls use(kernel, mesh, layout, n) for the kernels that must not leak and every layout.
template <class Use> void for_each_tight_way(const TriangleMesh& mesh, const Use& use) {
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        const auto layout = layout_of(mesh, entry);
        for (const KernelInfo& kernel : ray_kernels()) {
            if (kernel.promise == Promise::none)
                continue;
            SCOPED_TRACE(std::string(kernel.name) + " " + std::string(entry.name));
            use(kernel.name, *layout);
        }
    }
}

/// A place within the unit sphere mesh, and a target: a vertex, or on an edge, or an ulp aside.
class EdgeRays {
  public:
    EdgeRays(const TriangleMesh& mesh, float inside) : mesh_(mesh), inside_(inside) {}

    Ray<float> next() {
        std::uniform_real_distribution<float> place(-inside_, inside_), along(0, 1);
        const auto& corners = mesh_.triangles[random_() % mesh_.triangles.size()];
        const std::size_t k = random_() % 3;
        const Point a = mesh_.vertices[corners[k]], b = mesh_.vertices[corners[(k + 1) % 3]];
        const Point o =
            random_() % 8 == 0 ? Point{} : Point{place(random_), place(random_), place(random_)};
        const auto kind = random_() % 4;
        Point d = (kind == 0 ? a : kind == 1 ? .5f * (a + b) : a + along(random_) * (b - a)) - o;
        if (random_() % 4 == 0)
            for (int axis = 0; axis < 3; ++axis)
                d[axis] = std::nextafter(d[axis], random_() % 2 ? 9.0f : -9.0f);
        return {o, d};
    }

  private:
    const TriangleMesh& mesh_;
    float inside_;
    std::mt19937_64 random_{15};
};

TEST(RayLeaks, NoneAtTheEdgesAndVerticesOfASphere) {
    const TriangleMesh mesh = uv_sphere(64, 32);
    for_each_tight_way(mesh, [&](std::string_view kernel, const AnyLayout& layout) {
        EdgeRays edge_rays(mesh, .5f);
        for (std::size_t done = 0; done < n_rays(); done += 100000) {
            std::vector<Ray<float>> rays(std::min<std::size_t>(100000, n_rays() - done));
            for (Ray<float>& ray : rays)
                ray = edge_rays.next();
            ASSERT_EQ(leaks(layout, mesh, kernel, rays), 0u);
        }
    });
}

TEST(RayLeaks, NoneOfTheRaysThatLeakElsewhere) {
    // From the centre of the UV sphere to each vertex and edge midpoint, and the two directions
    // that Embree's robust mode misses.
    const TriangleMesh mesh = uv_sphere(64, 32);
    std::vector<Ray<float>> rays{{{}, {0x1.b36b92p-3f, 0x1.06cca2p-1f, 0x1.a9b662p-1f}},
                                 {{}, {0x1.792618p-3f, -0x1.cb8e9ep-3f, -0x1.e9f416p-1f}}};
    for (const Point& vertex : mesh.vertices)
        rays.push_back({{}, vertex});
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            rays.push_back({{}, .5f * (mesh.vertices[t[k]] + mesh.vertices[t[(k + 1) % 3]])});
    for_each_tight_way(mesh, [&](std::string_view kernel, const AnyLayout& layout) {
        EXPECT_EQ(leaks(layout, mesh, kernel, rays), 0u);
    });
    // The kernel below is seen to leak, or nothing was tested.
    EXPECT_GT(leaks(*layout_of(mesh, find_layout("binary")), mesh, "moller_trumbore_f32", rays),
              10u);
}

TEST(RayLeaks, NoneWhereTheShearUnderflows) {
    // A flat prism, and a sphere stretched by 1e60.
    constexpr float far = 1e10f;
    TriangleMesh prism;
    for (const float y : {-1e-36f, 3e-37f, 1e-36f})
        for (const auto& [x, z] : {std::pair{-far, -far}, {far, -far}, {far, far}, {-far, far}})
            prism.vertices.push_back({x, y, z});
    prism.triangles = {{0, 1, 2}, {0, 2, 3}, {8, 9, 10}, {8, 10, 11}};
    for (std::uint32_t level = 0; level < 8; level += 4)
        for (std::uint32_t i = 0; i < 4; ++i) {
            const std::uint32_t a = level + i, b = level + (i + 1) % 4;
            prism.triangles.push_back({a, b, b + 4});
            prism.triangles.push_back({a, b + 4, a + 4});
        }
    TriangleMesh sphere = uv_sphere(12, 6);
    for (Point& p : sphere.vertices)
        p = {1e30f * p.x, 1e-30f * p.y, p.z};
    std::vector<Ray<float>> at_sphere;
    for (const Point& p : sphere.vertices)
        at_sphere.push_back({{}, -.7f * p});
    for_each_tight_way(prism, [&](std::string_view kernel, const AnyLayout& layout) {
        const Ray<float> ray{{}, {1e10f, 6e-37f, 1e9f}};
        EXPECT_EQ(leaks(layout, prism, kernel, {&ray, 1}), 0u);
    });
    for_each_tight_way(sphere, [&](std::string_view kernel, const AnyLayout& layout) {
        EXPECT_EQ(leaks(layout, sphere, kernel, at_sphere), 0u);
    });
}

TEST(RayLeaks, NoneAtTheEndsOfTheRange) {
    // Coordinates up to the largest float below 2^126, and denormal ones; beyond it none are taken.
    const auto scaled_sphere = [](int exponent) {
        TriangleMesh mesh = uv_sphere(12, 6);
        for (Point& p : mesh.vertices)
            p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
        return mesh;
    };
    for (const int exponent : {125, 120, -120, -135}) {
        const TriangleMesh mesh = scaled_sphere(exponent);
        std::vector<Ray<float>> rays;
        for (const auto& [a, b, c] : mesh.triangles) {
            rays.push_back({{}, .5f * (mesh.vertices[a] + mesh.vertices[b])});
            rays.push_back({.25f * mesh.vertices[a], mesh.vertices[b] - .25f * mesh.vertices[a]});
        }
        for_each_tight_way(mesh, [&](std::string_view kernel, const AnyLayout& layout) {
            EXPECT_EQ(leaks(layout, mesh, kernel, rays), 0u) << exponent;
        });
    }
    const TriangleMesh beyond = scaled_sphere(126);
    for (const LayoutEntry& entry : layouts_answering({Query::rays}))
        EXPECT_THROW(layout_of(beyond, entry)->triangles(beyond), std::invalid_argument);
}

TEST(RayLeaks, BeyondTheLargestFloatEveryWayMisses) {
    // t = 10 / 1e-42 is none, 10 / 1e-37 = 1e38 is one: closest, any and all, in a batch and alone.
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    for (const LayoutEntry& entry : layouts_answering({Query::rays}))
        for (const KernelInfo& kernel : ray_kernels()) {
            SCOPED_TRACE(std::string(kernel.name) + " " + std::string(entry.name));
            const auto layout = layout_of(mesh, entry);
            const TriangleBlocks triangles = layout->triangles(mesh);
            on_every_target([&] {
                for (const float speed : {1e-42f, 1e-37f}) {
                    const Ray<float> ray{{.25f, .25f, -10}, {0, 0, speed}};
                    const bool expected = speed == 1e-37f;
                    for (const RayQuery query : {RayQuery::closest, RayQuery::any}) {
                        RayHit hit;
                        layout->rays({&ray, 1}, query, kernel.name, triangles, serial(), {&hit, 1});
                        EXPECT_EQ(hit.hit(), expected);
                    }
                    const SingleRays single(*layout, kernel.name, triangles);
                    EXPECT_EQ(single.closest(ray).hit(), expected);
                    EXPECT_EQ(single.any(ray), expected);
                    CountHits all;
                    layout->rays_all({&ray, 1}, kernel.name, triangles, serial(), all);
                    EXPECT_EQ(all.n, expected);
                }
            });
        }
}

TEST(RayLeaks, NoneAlongCorridors) {
    // Two triangles per wall, much longer than the way to where they are hit.
    std::mt19937 random(16);
    std::uniform_real_distribution<float> place(-.9f, .9f), along(-3, 3);
    for (const float half_length : {10.0f, 1000.0f, 1e5f}) {
        const TriangleMesh mesh = corridor(half_length, 0);
        std::vector<Ray<float>> rays;
        for (std::size_t i = 0; i < n_rays() / 10; ++i) {
            const float off = std::min(3e-7f * half_length, .01f);
            const Point o{place(random), place(random), place(random)};
            const Point target{(random() % 2 ? 1.0f : -1.0f) + off * place(random),
                               (random() % 2 ? 1.0f : -1.0f) + off * place(random), along(random)};
            rays.push_back({o, target - o});
        }
        for_each_tight_way(mesh, [&](std::string_view kernel, const AnyLayout& layout) {
            EXPECT_EQ(leaks(layout, mesh, kernel, rays), 0u) << half_length;
        });
    }
}

} // namespace
} // namespace boxwood
