#include "bench/explaining/explain.h"

#include "scenes/scene.h"
#include "trees/builder.h"
#include "trees/mesh_bvh.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(Explain, PairsAreThoseOfTheBoxes) {
    const Scene scene = make_scene({.generator = "uniform", .n = 60, .overlaps = 10});
    for (const char* builder : {"hilbert", "binned_sah"}) {
        const Tree tree = make_builder(builder)(scene.boxes, serial());
        std::size_t pairs = 0;
        for (std::uint32_t a = 0; a < 60; ++a)
            for (std::uint32_t b = 0; b < 60; ++b) {
                if (a == b)
                    continue;
                const Explanation why = explain_pair(tree, scene.boxes, a, b);
                const bool is_pair = overlaps(scene.boxes[a], scene.boxes[b]);
                pairs += is_pair;
                EXPECT_THAT(why.text,
                            StartsWith(fmt::format("Items {} and {} {} a pair: their boxes {}", a,
                                                   b, is_pair ? "are" : "are not",
                                                   is_pair ? "share" : "are apart along")));
                EXPECT_THAT(why.text, HasSubstr(is_pair ? "the pair is reported"
                                                        : "nothing below them is compared"));
            }
        EXPECT_GT(pairs, 100u);
    }
}

TEST(Explain, OneSharedPointIsAPairAndIsSaid) {
    const std::vector<Box> boxes{
        {{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{1.5f, 3, 0}, {2, 4, 1}}};
    const Tree tree = make_builder("hilbert")(boxes, serial());
    EXPECT_THAT(explain_pair(tree, boxes, 0, 1).text, HasSubstr("share (1, 1, 1) to (1, 1, 1)"));
    const Explanation apart = explain_pair(tree, boxes, 0, 2);
    EXPECT_THAT(apart.text, HasSubstr("are apart along y by 2 (1 and 3)"));
    EXPECT_THAT(apart.svg, HasSubstr(">2</text>"));
    EXPECT_THROW(explain_pair(tree, boxes, 0, 3), std::invalid_argument);
    EXPECT_THROW(explain_pair(tree, boxes, 1, 1), std::invalid_argument);
}

TEST(Explain, DoublesDecideWhereTheyAreGiven) {
    const std::vector<Aabb<double>> exact{{{0, 0, 0}, {1, 1, 1}}, {{1.000000001, 0, 0}, {2, 1, 1}}};
    const std::vector<Box> boxes{{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}};
    const Tree tree = make_builder("hilbert")(boxes, serial());
    const std::string text = explain_pair(tree, boxes, 0, 1, exact).text;
    EXPECT_THAT(text, StartsWith("Items 0 and 1 are not a pair: their boxes are apart along x by "
                                 "1e-09 (1 and 1.000000001)."));
    EXPECT_THAT(text, HasSubstr("the pair is dropped"));
    EXPECT_THAT(explain_pair(tree, boxes, 0, 1).text, HasSubstr("the pair is reported"));
    const std::vector<Box> one_ulp{{{0, 0, 0}, {1, 1, 1}}, {{1.0000001f, 0, 0}, {2, 1, 1}}};
    EXPECT_THAT(explain_pair(make_builder("hilbert")(one_ulp, serial()), one_ulp, 0, 1).text,
                HasSubstr("(1 and 1.0000001)"));
}

TEST(Explain, RaysMeetWhatTheQueryFinds) {
    const Scene scene =
        make_scene({.generator = "triangle_soup", .n = 300, .rays = "random", .n_rays = 200});
    const Tree tree = make_builder("binned_sah")(scene.boxes, serial());
    const MeshBvh bvh(scene.mesh);
    std::size_t hits = 0;
    for (const Ray<float>& ray : scene.rays) {
        const Explanation why = explain_ray(tree, scene.mesh, ray);
        const auto hit = bvh.closest_hit(ray);
        hits += hit.has_value();
        EXPECT_THAT(why.text,
                    HasSubstr(hit ? fmt::format("The nearest hit: triangle {} at t = {:.6g}",
                                                hit->triangle, hit->t)
                                  : "No triangle is hit."));
        EXPECT_THAT(why.svg, Not(HasSubstr("nan")));
    }
    EXPECT_GT(hits, 50u);
}

TEST(Explain, AHitBehindTheNearestIsNoMiss) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, .9f}, {1, 0, 1.1f}, {0, 1, .9f}, {0, 0, .92f}, {1, 0, .92f}, {0, 1, 6}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < 2; ++i)
        boxes.push_back(mesh.triangle(i).bounds());
    const Tree tree = make_builder("median")(boxes, serial());
    const std::string text = explain_ray(tree, mesh, {{.25f, .25f, 0}, {0, 0, 1}}).text;
    EXPECT_THAT(text, HasSubstr("triangle 1 is hit at t = 2.19, behind the hit at 0.95"));
    EXPECT_THAT(text, HasSubstr("The nearest hit: triangle 0 at t = 0.95"));
}

TEST(Explain, BodiesAndWhatTheSceneExpects) {
    const MovingScene scene(load_scene("four_link_arm"));
    const Explanation why = explain_body(scene, 1);
    EXPECT_THAT(why.text, StartsWith("Body 1 of four_link_arm, frame 0: moved by joint_motion."));
    EXPECT_THAT(why.text, HasSubstr("the scene file leaves them out by neighbours_ignored: 0."));
    EXPECT_THAT(why.text, Not(HasSubstr("the pair is reported")));
    EXPECT_THROW(explain_body(scene, 1000), std::invalid_argument);
}

} // namespace
} // namespace boxwood::bench
