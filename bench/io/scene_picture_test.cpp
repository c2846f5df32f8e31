#include "bench/io/scene_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

MovingScene scene_of(const std::string& text, std::size_t n) {
    return MovingScene(parse_scene_file(text, "mine.toml"), n);
}

TEST(ScenePicture, PairsAreThoseOfBruteForceWithoutTheExpected) {
    for (const BuiltInScene& entry : built_in_scenes()) {
        SCOPED_TRACE(entry.name);
        MovingScene scene(load_scene(std::string(entry.name)), 200);
        for (int frame = 0; frame < 5; ++frame) {
            std::vector<Pair> expected;
            const auto n = static_cast<std::uint32_t>(scene.bodies().size());
            for (std::uint32_t a = 0; a < n; ++a)
                for (std::uint32_t b = a + 1; b < n; ++b)
                    if (overlaps(fitted_box(scene.bodies(), a), fitted_box(scene.bodies(), b)) &&
                        !scene.is_ignored(a, b))
                        expected.push_back({a, b});
            EXPECT_EQ(overlapping_bodies(scene, boxed(scene.bodies())), expected);
            scene.advance();
        }
    }
}

TEST(ScenePicture, DrawsEachBodyOnceAndTheTree) {
    MovingScene scene = scene_of("[[bodies]]\ngenerator = \"cubes\"\n", 1);
    ScenePicture picture(scene, 0);
    picture.add(scene, {});
    picture.add(scene, scene.advance());
    const std::string svg = picture.svg();
    EXPECT_THAT(svg, HasSubstr("frame 0: 1 bodies, 0 changed, 0 pairs"));
    EXPECT_THAT(svg, HasSubstr("frame 1: 1 bodies, 0 changed, 0 pairs"));
    EXPECT_THAT(svg, HasSubstr("tree, depth 0"));
    // A cube seen along an axis is a square as wide as the panel, and so is its tree's box.
    EXPECT_THAT(svg, HasSubstr("d=\"M0 4400l4400 0 0 -4400 -4400 0Z\""));
}

TEST(ScenePicture, AbsentBodiesAreNotThere) {
    MovingScene scene = scene_of("[[bodies]]\ngenerator = \"cubes\"\neffects = {name = "
                                 "\"despawn\", often = 1}\n",
                                 50);
    EXPECT_EQ(boxed(scene.bodies()).boxes.size(), 50u);
    scene.advance();
    EXPECT_TRUE(boxed(scene.bodies()).boxes.empty());
    ScenePicture picture(scene, 2);
    picture.add(scene, {});
    EXPECT_THAT(picture.svg(), HasSubstr("0 bodies"));
    EXPECT_THAT(picture.svg(), Not(HasSubstr("nan")));
}

} // namespace
} // namespace boxwood::bench
