#include "bench/tasks/instruction_sets.h"

#include "bench/machine/environment.h"
#include "bench/plan/plan.h"
#include "bench/running/record.h"
#include "bench/tasks/task.h"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>
#include <string>

namespace boxwood::bench {
namespace {

TEST(InstructionSets, HoldOurCodeWhileTheyLive) {
    const std::string usual = isa_used();
    for (const std::string_view name : instruction_sets()) {
        if (missing_instruction_set(name))
            continue;
        const InstructionSetLimit limit(name);
        EXPECT_EQ(isa_used().starts_with("AVX2"), name == "avx2");
        EXPECT_EQ(isa_used().starts_with("AVX3"), name == "avx512");
    }
    EXPECT_EQ(isa_used(), usual);
    {
        const InstructionSetLimit none("");
        EXPECT_EQ(isa_used(), usual);
    }
    EXPECT_EQ(missing_instruction_set(""), std::nullopt);
    EXPECT_THROW(missing_instruction_set("avx"), std::invalid_argument);
}

TEST(InstructionSets, ChangeNoAnswerOfOursOrEmbrees) {
    const Plan plan = make_plan(R"(
[[cells]]
scene = "sphere_mesh"
n = 500
task = "rays_closest"
rays = "random"
n_rays = 200
isa = ["baseline", "avx2", "avx512", "native"]
builders = "binned_sah"
layouts = ["wide8", "quantised8", "binary"]
peers = ["embree.rtc_intersect1", "embree.rtc_intersect16.robust"]
[[cells]]
scene = "uniform"
n = 500
task = "pairs"
isa = ["baseline", "avx2", "avx512", "native"]
builders = ["hilbert", "binned_sah", "ploc", "lbvh", "median"]
layouts = ["packed", "wide8"]
peers = "embree.rtc_collide.low"
)",
                                "x.toml", {});
    std::map<std::string, Scene> scenes;
    std::map<std::string, std::uint64_t> hash_of; // of ours by the name without instruction set
    for (const PlannedCell& cell : plan.cells) {
        SCOPED_TRACE(cell.name);
        const auto [found, is_new] = scenes.try_emplace(scene_name(cell.scene));
        if (is_new)
            found->second = make_scene(cell.scene);
        const Job job{&found->second, cell.task, cell.executor, cell.threads, cell.isa};
        if (cell.contender.unsupported(job))
            continue;
        const InstructionSetLimit limit(cell.isa);
        const auto contender = cell.contender.make(job);
        const auto answers = cell.task->make_answers();
        contender->build();
        contender->query(*answers);
        const auto truth = cell.task->make_truth(found->second, 1);
        EXPECT_NE(truth->judge(*answers, cell.contender).status, results::Status::wrong);
        if (cell.contender.is_peer)
            continue;
        const std::uint64_t hash = cell.task->hash(*answers);
        std::string name = cell.name;
        if (!cell.isa.empty())
            name.resize(name.rfind('/'));
        EXPECT_EQ(hash_of.try_emplace(name, hash).first->second, hash);
    }
}

TEST(InstructionSets, AreClassesOfTheirOwn) {
    const Scene scene = make_scene({.generator = "uniform", .n = 10});
    const Task& task = *find_task("pairs");
    const ContenderEntry entry = peers_that_answer("pairs").front();
    Record record(environment(false), "test");
    const results::Cell usual = record.cell("a", {&scene, &task}, 0, entry),
                        held = record.cell("b", {&scene, &task, "serial", 1, "avx2"}, 0, entry);
    EXPECT_EQ(usual.classes, "");
    EXPECT_EQ(held.classes, "on avx2");
    EXPECT_EQ(held.isa, "avx2");
}

} // namespace
} // namespace boxwood::bench
