#include "bench/stages/plan_stages.h"

#include "bench/stages/playing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

using testing::Contains;
using testing::ElementsAre;

MovingScene scene_of(const std::string& text, std::size_t n = 20) {
    return MovingScene(parse_scene_file(text, "mine.toml"), n);
}

std::vector<std::string> required(const MovingScene& scene) {
    std::vector<std::string> names;
    for (const PlannedStage& stage : plan_stages(scene, Extent::required)) {
        EXPECT_FALSE(stage.why.empty()) << stage.name;
        EXPECT_EQ(stage.runs, stage.is_required) << stage.name;
        if (stage.runs)
            names.push_back(stage.name);
    }
    return names;
}

const std::string uniform = "[[bodies]]\ngenerator = \"uniform\"\n";
const std::string meshes = uniform + "shape = \"sphere_mesh\"\ntriangles = 20\n";

TEST(PlanStages, AStaticSceneThatQueriesPairsNeedsThreeStages) {
    EXPECT_THAT(required(MovingScene(load_scene("still_life"), 100)),
                ElementsAre("fit", "tree", "pairs"));
}

TEST(PlanStages, EachEffectBringsItsOwnStageAndNoOther) {
    for (const EffectEntry& effect : effects()) {
        SCOPED_TRACE(effect.name);
        const std::string word(effect.name);
        const auto stages = required(scene_of(meshes + "effects = \"" + word + "\"\n"));
        std::vector<std::string> expected{"advance_" + word};
        if (effect.changes.velocity)
            expected.push_back("move");
        for (const char* name : {"fit", "tree", "update", "pairs"})
            expected.push_back(name);
        EXPECT_EQ(stages, expected);
    }
}

TEST(PlanStages, AnEffectOnNobodyIsNotThere) {
    for (const EffectEntry& effect : effects())
        EXPECT_THAT(required(scene_of(meshes + "effects = {name = \"" + std::string(effect.name) +
                                      "\", share = 0}\n")),
                    ElementsAre("fit", "tree", "pairs"));
    // and what has no vertices is not deformed
    EXPECT_THAT(required(scene_of(uniform + "effects = \"deform\"\n")),
                ElementsAre("fit", "tree", "pairs"));
}

TEST(PlanStages, EachQueryBringsWhatItNeeds) {
    const auto of = [](const std::string& query, const std::string& bodies = meshes) {
        return required(scene_of("queries = \"" + query + "\"\n" + bodies));
    };
    EXPECT_THAT(of("triangle_pairs"),
                ElementsAre("fit", "tree", "pairs", "transform", "mesh_trees", "triangle_pairs"));
    EXPECT_THAT(of("triangle_pairs", uniform), ElementsAre()); // nobody has a mesh
    EXPECT_THAT(of("rays"), ElementsAre("surface", "aim", "rays"));
    for (const char* query : {"points", "regions", "nearest"})
        EXPECT_THAT(of(query), ElementsAre("fit", "box_tree", "aim", query));
    EXPECT_THAT(of("pairs", uniform + "neighbours_ignored = true\n"), Contains("filter"));
    EXPECT_THAT(of("pairs", uniform + "group_ignored = true\n"), Contains("filter"));
    EXPECT_THAT(of("rays", uniform + "group_ignored = true\n"), testing::Not(Contains("filter")));
}

TEST(PlanStages, EveryQueryHasAStageOfItsName) {
    const auto plan = plan_stages(scene_of(uniform), Extent::required);
    for (const SceneQueryEntry& query : scene_queries()) {
        EXPECT_NE(query_stage(query.name), nullptr);
        EXPECT_THAT(plan, Contains(testing::Field(&PlannedStage::name, std::string(query.name))));
    }
}

TEST(PlanStages, AllStagesRequireTheSame) {
    for (const BuiltInScene& entry : built_in_scenes()) {
        SCOPED_TRACE(entry.name);
        const MovingScene scene(load_scene(std::string(entry.name)), 100);
        const auto some = plan_stages(scene, Extent::required);
        const auto all = plan_stages(scene, Extent::all_stages);
        ASSERT_EQ(some.size(), all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            EXPECT_EQ(all[i].name, some[i].name);
            EXPECT_EQ(all[i].is_required, some[i].is_required);
            EXPECT_TRUE(all[i].runs || !some[i].runs);
        }
        for (const char* name :
             {"move", "fit", "tree", "update", "pairs", "filter", "transform", "mesh_trees"})
            EXPECT_TRUE(stage_of(all, name).runs) << name;
    }
}

} // namespace
} // namespace boxwood::bench
