#include "bench/running/inputs.h"

#include "bench/io/csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

namespace boxwood::bench {
namespace {

TEST(Inputs, AreNotNamedBySweepsWhoseScenesHaveNone) {
    std::size_t sweeps_with_inputs = 0;
    for (const auto& entry : std::filesystem::directory_iterator("bench/configs")) {
        const std::string file = entry.path().string();
        const std::string text = read_text(file);
        if (text.find("\ninputs = ") == text.npos)
            continue;
        ++sweeps_with_inputs;
        const Plan plan = make_plan(text, file, {});
        EXPECT_GT(plan.inputs, 1u) << file;
        EXPECT_TRUE(std::ranges::any_of(plan.cells, has_inputs)) << file;
    }
    EXPECT_GE(sweeps_with_inputs, 5u);
}

TEST(Inputs, ASceneOfTheNextInputHasTheNextSeed) {
    Plan plan = make_plan(R"(
seed = 5
inputs = 2
[[cells]]
scene = "uniform"
n = 100
task = "pairs"
builders = "lbvh"
)",
                          "a.toml", {});
    EXPECT_EQ(scene_in_round(plan, plan.cells.front(), 0).seed, 5u);
    EXPECT_EQ(scene_in_round(plan, plan.cells.front(), 3).seed, 6u);
    plan.cells.front().scene.file = "mine.obj";
    EXPECT_EQ(scene_in_round(plan, plan.cells.front(), 3).seed, 5u);
}

} // namespace
} // namespace boxwood::bench
