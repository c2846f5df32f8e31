#include "bench/commands/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

TEST(Plan, IsPrintedAsATableAndAsJson) {
    const MovingScene scene(load_scene("warehouse"), 1000);
    const std::string text = plan_text(scene, Extent::required, false);
    EXPECT_THAT(text, HasSubstr("warehouse: the scene requires 10 of 27 stages"));
    EXPECT_THAT(text, HasSubstr("2 effects change bodies"));
    EXPECT_THAT(text, HasSubstr("no body has this effect"));
    EXPECT_THAT(plan_text(scene, Extent::all_stages, false), HasSubstr("with all stages 13 run"));
    const std::string json = plan_text(scene, Extent::required, true);
    EXPECT_THAT(json, testing::StartsWith("{\"scene\":\"warehouse\",\"bodies\":1000,"));
    EXPECT_THAT(
        json,
        HasSubstr("{\"stage\":\"filter\",\"required\":false,\"runs\":false,\"on_device\":false,"
                  "\"why\":\"no pairs are ignored\"}"));
}

TEST(Plan, PlayingSaysWhatEachStageDid) {
    SceneFile file = load_scene("warehouse");
    file.n = 500;
    const std::string text = played_text(file, 3, serial());
    EXPECT_THAT(text, HasSubstr("500 bodies, 3 frames and the start: the same answers"));
    EXPECT_THAT(text, HasSubstr("advance_drift"));
    EXPECT_THAT(text, testing::Not(HasSubstr("advance_gravity")));
}

} // namespace
} // namespace boxwood::bench
