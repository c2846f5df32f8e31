#include "bench/io/scene_strip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(SceneStrip, ShowsTheFirstTheMiddleAndTheLastFrame) {
    SceneFile file = load_scene("warehouse");
    file.n = 200'000; // drawn with few
    file.frames = 10;
    const std::string svg = scene_strip(file);
    EXPECT_THAT(svg, testing::StartsWith("<svg"));
    for (const char* title : {"frame 0", "frame 5", "frame 10"})
        EXPECT_THAT(svg, HasSubstr(title));
    EXPECT_LT(svg.size(), max_strip_bytes);
    file.frames = 1;
    const std::string one = scene_strip(file);
    EXPECT_THAT(one, HasSubstr("frame 1"));
    EXPECT_THAT(one, Not(HasSubstr("frame 5")));
}

TEST(SceneStrip, EveryBuiltInSceneHasOne) {
    for (const BuiltInScene& scene : built_in_scenes()) {
        SceneFile file = load_scene(std::string(scene.name));
        file.frames = 4;
        EXPECT_NE(scene_strip(file), "") << scene.name;
    }
}

} // namespace
} // namespace boxwood::bench
