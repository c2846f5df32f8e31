#include "kernels/testing/closed_meshes.h"
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

/// Calls use(kernel, mesh, layout, n) for the kernels that must not leak and every layout.
template <class Use> void for_each_tight_way(const TriangleMesh& mesh, const Use& use) {
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        const auto layout = layout_of(mesh, entry);
        for (const std::string_view kernel : {"watertight", "exact"}) {
            SCOPED_TRACE(std::string(kernel) + " " + std::string(entry.name));
            use(kernel, *layout);
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
    EXPECT_GT(leaks(*layout_of(mesh, *find_layout("binary")), mesh, "moller_trumbore_f32", rays),
              10u);
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
