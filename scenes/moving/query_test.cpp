#include "scenes/moving/query.h"

#include "kernels/testing/complaint.h"
#include "scenes/moving/moving_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <algorithm>

namespace boxwood {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string uniform = "[[bodies]]\ngenerator = \"uniform\"\n";

SceneFile file_of(const std::string& queries) {
    return parse_scene_file((queries.empty() ? "" : "queries = " + queries + "\n") + uniform,
                            "mine.toml");
}

std::vector<std::string> names(const SceneFile& file) {
    std::vector<std::string> names;
    for (const SceneQuery& query : file.queries)
        names.push_back(query.name);
    return names;
}

std::string refusal(const std::string& text) {
    return complaint_of([&] { parse_scene_file(text, "mine.toml"); });
}

TEST(SceneQueries, AreReadFromTheFile) {
    EXPECT_THAT(names(file_of("")), ElementsAre("pairs"));
    EXPECT_THAT(names(file_of("\"rays\"")), ElementsAre("rays"));
    const SceneFile file = file_of(
        "[\"triangle_pairs\", {name = \"regions\", n = 7, size = 2.5, kind = \"scattered\"}, "
        "{name = \"nearest\", k = 3}]");
    EXPECT_THAT(names(file), ElementsAre("triangle_pairs", "regions", "nearest"));
    EXPECT_EQ(file.queries[1].n, 7u);
    EXPECT_EQ(file.queries[1].size, 2.5);
    EXPECT_EQ(file.queries[1].kind, "scattered");
    EXPECT_EQ(file.queries[2].k, 3u);
    EXPECT_EQ(file.queries[2].n, 1000u);
    EXPECT_EQ(query_named(file, "regions"), &file.queries[1]);
    EXPECT_EQ(query_named(file, "pairs"), nullptr);
}

TEST(SceneQueries, BadOnesAreRefusedWithTheirPlace) {
    const auto of = [](const std::string& queries) {
        return refusal("n = 10\nqueries = " + queries + "\n" + uniform);
    };
    EXPECT_THAT(of("\"pears\""),
                HasSubstr("mine.toml:2: queries: unknown name 'pears'; did you mean "
                          "'pairs'?"));
    EXPECT_THAT(of("[]"), HasSubstr("mine.toml:2: queries must name something"));
    EXPECT_THAT(of("3"), HasSubstr("mine.toml:2: a query is a name, or"));
    EXPECT_THAT(of("{n = 3}"), HasSubstr("a query is a name, or"));
    EXPECT_THAT(of("[\"rays\", \"rays\"]"), HasSubstr("mine.toml:2: 'rays' is named twice"));
    EXPECT_THAT(of("{name = \"pairs\", n = 3}"), HasSubstr("key of the query pairs 'n'"));
    EXPECT_THAT(of("{name = \"rays\", knd = \"flying\"}"), HasSubstr("did you mean 'kind'?"));
    EXPECT_THAT(of("{name = \"rays\", kind = \"flyng\"}"), HasSubstr("did you mean 'flying'?"));
    EXPECT_THAT(of("{name = \"rays\", n = 0}"), HasSubstr("n = 0 is out of range"));
    EXPECT_THAT(of("{name = \"rays\", n = 1.5}"), HasSubstr("n must be a whole number"));
    EXPECT_THAT(of("{name = \"nearest\", k = 0}"), HasSubstr("k = 0 is out of range"));
    EXPECT_THAT(of("{name = \"regions\", size = nan}"), HasSubstr("out of range"));
    EXPECT_THAT(refusal(uniform + "margin = -1\n"), HasSubstr("mine.toml:3: margin = -1 is out"));
    EXPECT_THAT(refusal(uniform + "group_ignored = 3\n"),
                HasSubstr("mine.toml:3: group_ignored must be true or false"));
    EXPECT_THAT(refusal(uniform + "group_ignord = true\n"),
                HasSubstr("did you mean 'group_ignored'?"));
}

TEST(SceneQueries, FiltersAndMarginsAreThoseOfTheirGroups) {
    const MovingScene scene(parse_scene_file(uniform + "n = 5\nmargin = 0.5\n" + uniform +
                                                 "n = 3\ngroup_ignored = true\n" + uniform +
                                                 "n = 2\nneighbours_ignored = true\n",
                                             "mine.toml"));
    std::vector<std::array<std::uint32_t, 2>> ignored;
    for (std::uint32_t a = 0; a < 10; ++a)
        for (std::uint32_t b = a + 1; b < 10; ++b)
            if (scene.is_ignored(a, b))
                ignored.push_back({a, b});
    using P = std::array<std::uint32_t, 2>;
    EXPECT_THAT(ignored, ElementsAre(P{5, 6}, P{5, 7}, P{6, 7}, P{8, 9}));
    for (std::uint32_t i = 0; i < 10; ++i) {
        const Aabb<float> box = fitted_box(scene.bodies(), i), wide = pair_box(scene, i);
        const float more = i < 5 ? .5f : 0;
        EXPECT_TRUE(wide.contains(box));
        EXPECT_NEAR(box.min.x - wide.min.x, more, 1e-6);
        EXPECT_NEAR(wide.max.z - box.max.z, more, 1e-6);
    }
}

TEST(SceneQueries, QueriesGoWithTheFrameAndAreTheSameOnEveryMachine) {
    MovingScene scene(load_scene("still_life"), 100);
    const Aabb<double> bounds = scene.bodies().bounds;
    std::uint64_t hash = 0;
    for (const QueryKindEntry& kind : query_kinds()) {
        const SceneQuery query{
            .name = "regions", .kind = std::string(kind.name), .n = 50, .k = 0, .size = 2};
        std::vector<Ray<float>> rays, rays_before;
        std::vector<Vec3<float>> points;
        std::vector<Aabb<float>> regions, regions_before;
        for (int frame = 0; frame < 40; ++frame) {
            rays_of_frame(scene, query, rays);
            points_of_frame(scene, query, points);
            regions_of_frame(scene, query, regions);
            ASSERT_EQ(rays.size(), 50u);
            ASSERT_EQ(points.size(), 50u);
            ASSERT_EQ(regions.size(), 50u);
            EXPECT_NE(regions, regions_before);
            regions_before = regions;
            const Vec3<double> grown = .1 * (bounds.max - bounds.min);
            const Aabb<double> near{bounds.min - grown, bounds.max + grown};
            for (const Ray<float>& ray : rays) {
                EXPECT_TRUE(near.contains(static_cast<Vec3<double>>(ray.origin)));
                EXPECT_TRUE(is_finite(ray.direction));
                EXPECT_GT(dot(ray.direction, ray.direction), .5f);
            }
            for (const Vec3<float>& point : points)
                EXPECT_TRUE(near.contains(static_cast<Vec3<double>>(point)));
            for (const Aabb<float>& region : regions)
                EXPECT_TRUE(region.is_valid());
            hash = XXH3_64bits_withSeed(rays.data(), rays.size() * sizeof(rays[0]), hash);
            hash = XXH3_64bits_withSeed(points.data(), points.size() * sizeof(points[0]), hash);
            hash = XXH3_64bits_withSeed(regions.data(), regions.size() * sizeof(regions[0]), hash);
            scene.advance();
        }
    }
    EXPECT_EQ(hash, 1408690262641514390u);
}

TEST(SceneQueries, ACameraFliesThroughAFlatRoom) {
    MovingScene scene(parse_scene_file(uniform + "n = 1\n", "mine.toml")); // bounds of one point
    std::vector<Ray<float>> rays;
    for (int frame = 0; frame < 5; ++frame) {
        rays_of_frame(scene, {.name = "rays", .kind = "flying", .n = 9}, rays);
        for (const Ray<float>& ray : rays)
            EXPECT_TRUE(is_finite(ray.origin) && is_finite(ray.direction));
        scene.advance();
    }
}

TEST(MovingScene, RewindsIfItWasMadeTo) {
    for (const BuiltInScene& entry : built_in_scenes()) {
        SCOPED_TRACE(entry.name);
        MovingScene scene(load_scene(std::string(entry.name)), 100, true);
        const auto play = [&] {
            std::vector<Aabb<float>> boxes;
            for (int frame = 0; frame < 10; ++frame) {
                for (std::uint32_t i = 0; i < scene.bodies().size(); ++i)
                    boxes.push_back(fitted_box(scene.bodies(), i));
                scene.advance();
            }
            return boxes;
        };
        const auto first = play();
        scene.rewind();
        EXPECT_EQ(scene.frame(), 0u);
        EXPECT_EQ(play(), first);
    }
    MovingScene once(load_scene("crowd"), 10);
    EXPECT_THROW(once.rewind(), std::logic_error);
}

TEST(MovingScene, BodiesOfOneSizeDeformEachByItself) {
    MovingScene scene(
        parse_scene_file(
            "[[bodies]]\ngenerator = \"cubes\"\nshape = \"sphere_mesh\"\ntriangles = 40\n"
            "effects = {name = \"deform\", share = 0.5}\n",
            "mine.toml"),
        40);
    const Bodies before = scene.bodies();
    const auto changed = scene.advance();
    EXPECT_GT(changed.size(), 5u);
    EXPECT_LT(changed.size(), 35u);
    for (std::uint32_t i = 0; i < 40; ++i) {
        const bool has_changed = std::ranges::binary_search(changed, i);
        const auto& now = scene.bodies();
        EXPECT_EQ(now.meshes[now.mesh[i]].vertices != before.meshes[before.mesh[i]].vertices,
                  has_changed);
    }
}

} // namespace
} // namespace boxwood
