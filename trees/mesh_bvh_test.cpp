#include "trees/mesh_bvh.h"

#include "trees/builders/hilbert.h"
#include "trees/builders/spatial_sah.h"
#include "trees/testing/brute_force_rays.h"
#include "trees/testing/ray_scenes.h"
#include "trees/testing/triangle_soup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace boxwood {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<MeshBvhOptions> some_mesh_options() {
    return {{},
            {.builder = SpatialSahBuilder{}, .layout = LayoutName::wide16, .threads = 2},
            {.builder = HilbertBuilder{},
             .layout = LayoutName::packed,
             .kernel = RayKernelName::exact,
             .executor = make_executor("openmp", 2)},
            {.layout = LayoutName::binary, .kernel = RayKernelName::moller_trumbore_f64}};
}

template <RayKernel K> std::vector<RayHit> all_of(const TriangleMesh& mesh, const Ray<float>& ray) {
    std::vector<RayHit> hits;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        RayHit hit;
        if (K::intersect(K::prepare(ray), ray, mesh.triangle(i), ray.t_max, hit)) {
            hit.triangle = i;
            hits.push_back(hit);
        }
    }
    std::ranges::sort(hits, [](const RayHit& a, const RayHit& b) {
        return a.t != b.t ? a.t < b.t : a.triangle < b.triangle;
    });
    return hits;
}

template <RayKernel K> void expect_answers(const MeshBvh& bvh, const TriangleMesh& mesh) {
    const std::vector<Ray<float>> rays = test_rays();
    const std::vector<RayHit> wanted = brute_force<K>(mesh, rays);
    EXPECT_EQ(bvh.closest_hits(rays), wanted);
    const std::vector<RayHit> any = bvh.any_hits(rays);
    const AnswersOf<RayHit> all = bvh.all_hits(rays);
    ASSERT_EQ(all.size(), rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::optional<RayHit> hit = bvh.closest_hit(rays[i]);
        EXPECT_EQ(hit.value_or(RayHit{}), wanted[i]);
        EXPECT_EQ(hit.has_value(), wanted[i].hit());
        EXPECT_EQ(bvh.any_hit(rays[i]), wanted[i].hit());
        EXPECT_EQ(any[i].hit(), wanted[i].hit());
        const std::vector<RayHit> each = all_of<K>(mesh, rays[i]);
        EXPECT_EQ(std::vector<RayHit>(all[i].begin(), all[i].end()), each);
        if (i % 16 == 0) {
            EXPECT_EQ(bvh.all_hits(rays[i]), each);
        }
    }
}

void expect_answers(const MeshBvh& bvh, const TriangleMesh& mesh) {
    if (bvh.options().kernel == RayKernelName::watertight)
        expect_answers<Watertight>(bvh, mesh);
    else if (bvh.options().kernel == RayKernelName::exact)
        expect_answers<ExactRayTriangle>(bvh, mesh);
    else
        expect_answers<MollerTrumbore<double>>(bvh, mesh);
}

TEST(MeshBvh, AnswersRaysAsBruteForceWithAnyOptions) {
    for (const TriangleMesh& mesh : {sphere(8), triangle_soup(300), TriangleMesh{}})
        for (const MeshBvhOptions& options : some_mesh_options()) {
            SCOPED_TRACE(static_cast<int>(options.layout));
            expect_answers(MeshBvh(mesh, options), mesh);
            expect_answers(MeshBvh(mesh.vertices, mesh.triangles, options), mesh);
        }
}

TEST(MeshBvh, FindsTheClosestPoint) {
    const TriangleMesh mesh = triangle_soup(200);
    const MeshBvh bvh(mesh), split(mesh, {.builder = SpatialSahBuilder{}});
    const std::vector<Vec3<float>> points = triangle_soup(50, 9).vertices;
    const std::vector<SurfacePoint> many = bvh.closest_points(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        SurfacePoint best;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const Triangle<float> f = mesh.triangle(t);
            const auto found = point_triangle::Regions::nearest(
                Vec3<double>(points[i]),
                Triangle<double>{Vec3<double>(f.a), Vec3<double>(f.b), Vec3<double>(f.c)});
            const double squared = dot(found.offset, found.offset);
            if (squared < best.squared_distance)
                best = {Vec3<float>(found.b), t, squared};
        }
        for (const auto& found :
             {bvh.closest_point(points[i]), split.closest_point(points[i]), {many[i]}}) {
            ASSERT_TRUE(found);
            EXPECT_EQ(found->triangle, best.triangle);
            EXPECT_EQ(found->point, best.point);
            EXPECT_EQ(found->squared_distance, best.squared_distance);
        }
    }
    EXPECT_FALSE(MeshBvh().closest_point({0, 0, 0}));
    EXPECT_FALSE(bvh.closest_point({0, 0, RayHit::nowhere}));
}

TEST(MeshBvh, FollowsAMeshThatMovesAndMovesItself) {
    for (const MeshBvhOptions& options : some_mesh_options()) {
        TriangleMesh mesh = sphere(6);
        MeshBvh bvh(mesh, options);
        for (Vec3<float>& v : mesh.vertices)
            v = v * .5f + Vec3<float>{.1f, .2f, .3f};
        bvh.update(mesh.vertices);
        expect_answers(bvh, mesh);
        MeshBvh other;
        other = std::move(bvh);
        const MeshBvh last(std::move(other));
        expect_answers(last, mesh);
    }
}

TEST(MeshBvh, RefusesBadMeshesAndStaysAsItWas) {
    const TriangleMesh good = sphere(5);
    TriangleMesh bad = good;
    bad.triangles[7][2] = 1000;
    EXPECT_THAT([&] { MeshBvh x(bad); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("triangle 7")));
    EXPECT_THROW(MeshBvh(good, {.builder = BuildFunction{}}), std::invalid_argument);
    EXPECT_THROW(MeshBvh(good, {.threads = 0}), std::invalid_argument);
    for (const MeshBvhOptions& options : some_mesh_options()) {
        MeshBvh bvh(good, options);
        for (const float not_good :
             {std::numeric_limits<float>::quiet_NaN(), RayHit::nowhere, -max_ray_coordinate}) {
            bad = good;
            bad.vertices[good.triangles[3][1]].y = not_good;
            EXPECT_THROW(MeshBvh(bad, options), std::invalid_argument);
            EXPECT_THROW(bvh.update(bad.vertices), std::invalid_argument);
        }
        EXPECT_THROW(bvh.update({}), std::invalid_argument);
        EXPECT_THROW(bvh.closest_hits(test_rays(), {}), std::invalid_argument);
        expect_answers(bvh, good);
    }
}

} // namespace
} // namespace boxwood
