#include "scenes/sampling/rays.h"

#include "kernels/testing/complaint.h"
#include "scenes/scene.h"
#include "scenes/text/bad_input.h"
#include "scenes/text/testing/file_of.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace boxwood {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A plain text-book test in double: good enough to count hits, not to judge edges.
bool meets(const Ray<float>& ray, const Triangle<float>& triangle) {
    const auto a = Vec3<double>(triangle.a), d = Vec3<double>(ray.direction);
    const auto e = Vec3<double>(triangle.b) - a, f = Vec3<double>(triangle.c) - a;
    const auto p = cross(d, f), s = Vec3<double>(ray.origin) - a, q = cross(s, e);
    const double det = dot(e, p), u = dot(s, p) / det, v = dot(d, q) / det, t = dot(f, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= static_cast<double>(ray.t_max);
}

double share_of_hits(const Scene& scene) {
    int hits = 0;
    for (const Ray<float>& ray : scene.rays)
        for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i)
            if (meets(ray, scene.mesh.triangle(i))) {
                ++hits;
                break;
            }
    return hits / static_cast<double>(scene.rays.size());
}

Scene sphere(std::string kind, std::size_t n_rays = 1000) {
    return make_scene(
        {.generator = "sphere_mesh", .n = 800, .rays = std::move(kind), .n_rays = n_rays});
}

// The bounding sphere of the box has about sqrt(3) times the mesh's radius; seen from 2.5 of it,
// the square image of side 0.88 holds a disc of radius 0.24: a share of about 0.23.
TEST(Rays, PrimaryRaysSeeTheMeshRowByRow) {
    const Scene scene = sphere("primary");
    EXPECT_NEAR(share_of_hits(scene), 0.23, 0.05);
    ASSERT_EQ(scene.rays.size(), 1000u);
    for (std::size_t i = 0; i < 1000; ++i) {
        EXPECT_EQ(scene.rays[i].origin, scene.rays[0].origin);
        EXPECT_TRUE(std::isinf(scene.rays[i].t_max));
        if (i % 32 != 0) { // neighbours in a row of 32 differ by a pixel
            EXPECT_LT(length(scene.rays[i].direction - scene.rays[i - 1].direction), 0.04f);
        }
    }
    EXPECT_GT(length(scene.rays[31].direction - scene.rays[32].direction), 0.5f);
}

TEST(Rays, PrimaryRaysAloneAreAPicture) {
    for (const RayKindEntry& kind : ray_kinds())
        EXPECT_EQ(picture_width(kind.name, 1000), kind.name == "primary" ? 32u : 0u);
    EXPECT_EQ(picture_width("primary", 1024), 32u);
    EXPECT_EQ(picture_width("primary", 1025), 33u);
}

TEST(Rays, RandomRaysStartOutsideAndOftenHit) {
    const Scene scene = sphere("random");
    const double hits = share_of_hits(scene);
    EXPECT_GT(hits, 0.2);
    EXPECT_LT(hits, 0.8);
    for (const Ray<float>& ray : scene.rays) {
        EXPECT_GT(length(ray.origin), 1.3f); // the mesh ends at 1.15
        EXPECT_NEAR(length(ray.direction), 1, 1e-6);
    }
}

// On a sphere they would all escape; the bumps stop some.
TEST(Rays, AmbientRaysLeaveTheSurfaceOutward) {
    const Scene scene = sphere("ambient");
    EXPECT_LT(share_of_hits(scene), 0.25);
    double cosine = 0;
    for (const Ray<float>& ray : scene.rays) {
        EXPECT_GT(length(ray.origin), 0.8f);
        EXPECT_LT(length(ray.origin), 1.2f);
        EXPECT_TRUE(std::isfinite(ray.t_max) && ray.t_max > 1);
        cosine += static_cast<double>(dot(ray.origin, ray.direction) / length(ray.origin));
    }
    EXPECT_NEAR(cosine / 1000, 2 / 3., 0.06); // mean cosine of a cosine-weighted hemisphere
}

// Half of a sphere is in shadow of its other half.
TEST(Rays, OcclusionRaysEndAtOneLight) {
    const Scene scene = sphere("occlusion");
    const Vec3<float> light = scene.rays[0].origin + scene.rays[0].direction;
    for (const Ray<float>& ray : scene.rays) {
        EXPECT_LT(length(ray.origin + ray.direction - light), 1e-5f);
        EXPECT_EQ(ray.t_max, 1);
    }
    EXPECT_GT(length(light), 2.f);
    EXPECT_NEAR(share_of_hits(scene), 0.6, 0.2);
}

TEST(Rays, SurfacePointsAreSpreadByArea) {
    TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 0, 0}, {12, 0, 0}, {9, 3, 0}},
                      {{0, 1, 2}, {2, 2, 2}, {3, 4, 5}}}; // areas 1/2, 0, 9/2
    const auto rays = make_rays("ambient", mesh, 4000, 1);
    const auto near =
        std::ranges::count_if(rays, [](const Ray<float>& ray) { return ray.origin.x < 5; });
    EXPECT_NEAR(static_cast<double>(near) / 4000, 0.1, 0.02);
}

TEST(Rays, OddMeshesGiveFiniteRaysOrAnError) {
    const TriangleMesh point{{{5, 5, 5}}, {{0, 0, 0}}};
    const TriangleMesh far{{{1e6f, 1e6f, 0}, {1e6f + 1, 1e6f, 0}, {1e6f, 1e6f + 1, 0}},
                           {{0, 1, 2}}};
    for (const RayKindEntry& kind : ray_kinds()) {
        EXPECT_EQ(make_rays(kind.name, point, 50, 1).size(), 50u);
        EXPECT_EQ(make_rays(kind.name, far, 50, 1).size(), 50u);
        EXPECT_THROW(make_rays(kind.name, {}, 1, 1), std::invalid_argument);
    }
    for (const float size : {3e38f, 0x1p125f}) { // the camera stands 2.5 radii away
        const TriangleMesh huge{{{-size, 0, 0}, {size, 0, 0}, {0, size, 0}}, {{0, 1, 2}}};
        try {
            make_rays("primary", huge, 50, 1);
            ADD_FAILURE() << size;
        } catch (const std::runtime_error& error) {
            EXPECT_THAT(error.what(),
                        AllOf(HasSubstr("below 2^126 (8.5e37)"), HasSubstr("scale the mesh down")));
        }
    }
    for (const Ray<float>& ray : make_rays("ambient", far, 50, 1))
        EXPECT_GT(ray.origin.z, 0); // off the surface in spite of the far origin
}

TEST(OwnRays, TmaxIsRoundedDownAndMayBeInfinite) {
    const std::vector<Ray<float>> rays =
        parse_rays("0,0,0,1,0,0\n1,2,3,0,0,-2,7.5\n.2,.2,1,0,0,-1,0.99999999\n"
                   "0,0,0,1,0,0,inf\n0,0,0,1,0,0,1e300\n",
                   "rays.csv");
    ASSERT_EQ(rays.size(), 5u);
    EXPECT_EQ(rays[0].t_max, std::numeric_limits<float>::infinity());
    EXPECT_EQ(rays[1].origin, (Vec3<float>{1, 2, 3}));
    EXPECT_EQ(rays[1].direction, (Vec3<float>{0, 0, -2}));
    EXPECT_EQ(rays[1].t_max, 7.5f);
    EXPECT_EQ(rays[2].t_max, std::nextafter(1.0f, 0.0f)); // its nearest float is 1
    EXPECT_EQ(rays[3].t_max, std::numeric_limits<float>::infinity());
    EXPECT_EQ(rays[4].t_max, std::numeric_limits<float>::max());
}

TEST(OwnRays, BadRowsAndFilesWithoutRowsAreNamed) {
    const auto of = [](const std::string& text) {
        return complaint_of<BadInput>([&] { parse_rays(text, "rays.csv"); });
    };
    EXPECT_THAT(of("0,0,0,0,0,0\n"), HasSubstr("rays.csv:1: the direction dx,dy,dz is zero"));
    EXPECT_THAT(of("0,0,0,1,0\n"), HasSubstr(":1: 5 columns, expected 6 to 7: ox,oy,oz,dx,"));
    EXPECT_THAT(of("0,0,1e38,1,0,0\n"), HasSubstr("oz is 1e+38; a ray needs finite numbers"));
    EXPECT_THAT(of("0,0,1,1,0,0,-1\n"), HasSubstr("tmax is -1"));
    EXPECT_TRUE(parse_rays("# none\n", "rays.csv").empty());
    const FileOf none("# none\n"), one("0,0,0,1,0,0\n");
    EXPECT_EQ(read_rays(one.path()).size(), 1u);
    EXPECT_THAT(complaint_of<BadInput>([&] { read_rays(none.path()); }), HasSubstr("no rows of"));
}

} // namespace
} // namespace boxwood
