#include "scenes/sampling/queries.h"

#include "scenes/scene.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace boxwood {
namespace {

SceneSpec spec_of(std::string generator, std::string regions) {
    SceneSpec spec{.generator = std::move(generator), .n = 4000};
    spec.n_points = 600;
    spec.regions = std::move(regions);
    return spec;
}

bool meet(const Aabb<float>& region, const Aabb<float>& item) { return overlaps(region, item); }
bool meet(const Sphere<float>& region, const Aabb<float>& item) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = std::max(
            {0.0, static_cast<double>(item.min[axis]) - static_cast<double>(region.centre[axis]),
             static_cast<double>(region.centre[axis]) - static_cast<double>(item.max[axis])});
        sum += d * d;
    }
    return std::sqrt(sum) <= static_cast<double>(region.radius);
}

template <class Region> double mean_items(const Scene& scene, const std::vector<Region>& regions) {
    std::size_t met = 0;
    for (const Region& region : regions)
        for (const Aabb<float>& item : scene.boxes)
            met += meet(region, item);
    return static_cast<double>(met) / static_cast<double>(regions.size());
}

TEST(Queries, HalfOfThePointsLieInAnItemOrBesideIt) {
    const Scene scene = make_scene(spec_of("sphere_mesh", ""));
    EXPECT_EQ(scene.name, "sphere_mesh_points");
    ASSERT_EQ(scene.points.size(), 600u);
    EXPECT_TRUE(scene.regions.empty() && scene.spheres.empty());
    std::size_t beside = 0;
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        bool near = false;
        for (const Aabb<float>& item : scene.boxes) {
            const Vec3<float> half = 0.51f * (item.max - item.min);
            near |= Aabb<float>{item.min - half, item.max + half}.contains(scene.points[i]);
        }
        beside += near;
        if (i % 2 == 0) {
            EXPECT_TRUE(near) << i;
        }
    }
    EXPECT_LT(beside, 400u) << "the others should be anywhere";
}

TEST(Queries, RegionsMeetAboutTenItems) {
    for (const char* generator : {"uniform", "clusters", "sphere_mesh"}) {
        SCOPED_TRACE(generator);
        const Scene boxes = make_scene(spec_of(generator, "boxes"));
        ASSERT_EQ(boxes.regions.size(), 600u);
        EXPECT_GT(mean_items(boxes, boxes.regions), 4);
        EXPECT_LT(mean_items(boxes, boxes.regions), 25);
        const Scene balls = make_scene(spec_of(generator, "spheres"));
        ASSERT_EQ(balls.spheres.size(), 600u);
        EXPECT_GT(mean_items(balls, balls.spheres), 4);
        EXPECT_LT(mean_items(balls, balls.spheres), 25);
        EXPECT_NE(boxes.content_hash, balls.content_hash);
    }
}

TEST(Queries, DoNotDependOnTheirNumber) {
    SceneSpec spec = spec_of("uniform", "");
    const Scene many = make_scene(spec);
    spec.n_points = 10;
    spec.k = 8;
    const Scene few = make_scene(spec);
    EXPECT_EQ(few.name, "uniform_points_k8");
    EXPECT_NE(few.params_json.find("\"n_points\":10,\"k\":8}"), std::string::npos)
        << few.params_json;
    for (std::size_t i = 0; i < few.points.size(); ++i)
        EXPECT_EQ(few.points[i], many.points[i]);
}

TEST(Queries, RefuseWhatDoesNotGoTogether) {
    EXPECT_THROW(make_scene(spec_of("uniform", "sphere")), std::invalid_argument);
    SceneSpec none = spec_of("uniform", "boxes");
    none.n_points = 0;
    EXPECT_THROW(make_scene(none), std::invalid_argument);
    SceneSpec k = spec_of("uniform", "boxes");
    k.k = 2;
    EXPECT_THROW(make_scene(k), std::invalid_argument);
    k.regions.clear();
    k.k = 0;
    EXPECT_THROW(make_scene(k), std::invalid_argument);
    EXPECT_THROW(make_points({}, 1, 1), std::invalid_argument);
    EXPECT_TRUE(make_points({}, 0, 1).empty());
}

} // namespace
} // namespace boxwood
