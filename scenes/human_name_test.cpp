#include "scenes/human_name.h"

#include "scenes/effects/effect_scene.h"
#include "scenes/sampling/queries.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>

namespace boxwood {
namespace {

TEST(HumanName, SaysWhatAGeneratorMakes) {
    EXPECT_EQ(human_name({.generator = "uniform", .n = 100'000}),
              "100,000 uniform boxes, 10 overlaps each");
    EXPECT_EQ(human_name({.generator = "bars", .n = 999, .overlaps = 1}),
              "999 long bars, 1 overlap each");
    EXPECT_EQ(human_name({.generator = "clusters", .n = 1'234'567, .overlaps = .5}),
              "1,234,567 clustered boxes, 0.5 overlaps each");
    EXPECT_EQ(human_name({.generator = "sphere_mesh", .n = 100'000, .rays = "primary"}),
              "sphere mesh, 100,000 triangles, primary rays");
    EXPECT_EQ(human_name({.generator = "four_link", .n = 4}), "robot arm of four links");
    EXPECT_EQ(human_name({.generator = "mesh", .rays = "ambient", .file = "data/bunny.obj"}),
              "mesh bunny, ambient rays");
}

TEST(HumanName, SaysWhatIsQueried) {
    EXPECT_EQ(human_name({.generator = "cubes", .n = 1000, .n_points = 2000}),
              "1,000 unit cubes, 2,000 points");
    EXPECT_EQ(human_name({.generator = "cubes", .n = 1000, .n_points = 20, .k = 8}),
              "1,000 unit cubes, 20 points, 8 nearest each");
    EXPECT_EQ(human_name({.generator = "cubes", .n = 1000, .n_points = 50, .regions = "spheres"}),
              "1,000 unit cubes, 50 regions, spheres");
}

TEST(HumanName, SaysWhatHappensToMovingBodies) {
    const auto name = [](const SceneFile& file, std::size_t n) {
        return human_name({.n = n, .moving = std::make_shared<const SceneFile>(file)});
    };
    const SceneFile drifting = effect_scene({.generator = "uniform", .n = 100'000, .overlaps = 1},
                                            std::vector{EffectChoice{"drift", {}, .01}});
    EXPECT_EQ(name(drifting, 100'000), "100,000 uniform boxes, 1 overlap each, 1 % drift");
    const SceneFile turning =
        effect_scene({.generator = "cubes"}, std::vector{EffectChoice{"spin", {{"rate", 3}}, 1},
                                                         EffectChoice{"teleport", {}, .125}});
    EXPECT_EQ(name(turning, 50), "50 unit cubes, spin (rate 3), 12.5 % teleport");
    EXPECT_EQ(name(load_scene("drone_swarm"), 10'000), "drone swarm, 10,000 bodies");
}

TEST(HumanName, OfHardCasesSaysParameterAndScale) {
    for (const HardCaseFamily& family : hard_case_families()) {
        SceneSpec spec{.generator = std::string(family.name), .n = 500, .scale = -3};
        const std::string name = human_name(spec);
        EXPECT_NE(name.find("500 cases"), std::string::npos) << name;
        EXPECT_NE(name.find("scaled by 2^-3"), std::string::npos) << name;
        EXPECT_EQ(name.find("k = ") != std::string::npos,
                  !family.k_meaning.empty() && !family.k_words)
            << name;
        EXPECT_EQ(name.find('_'), std::string::npos) << name;
    }
}

TEST(HumanName, OfPairsOfShapesSaysHowManyOverlap) {
    const auto name = [](int k) {
        return human_name({.generator = "box_and_cone", .n = 1000, .k = k});
    };
    EXPECT_EQ(name(0), "box and cone, 1,000 cases, apart");
    EXPECT_EQ(name(50), "box and cone, 1,000 cases, 50 % of them overlap");
    EXPECT_EQ(name(100), "box and cone, 1,000 cases, overlapping");
}

TEST(HumanName, IsOneForEachSceneAndNoPlaceIsLeftOpen) {
    std::set<std::string> names;
    for (const SceneEntry& entry : scene_generators())
        for (const std::string rays : {"", "primary"}) {
            if (!rays.empty() && !entry.has_mesh)
                continue;
            const std::string name = human_name(
                {.generator = std::string(entry.name), .n = 5, .rays = rays, .file = "x.obj"});
            EXPECT_TRUE(names.insert(name).second) << name;
            EXPECT_EQ(name.find_first_of("{}_"), std::string::npos) << name;
        }
    EXPECT_THROW(human_name({.generator = "unifrom"}), std::invalid_argument);
}

} // namespace
} // namespace boxwood
