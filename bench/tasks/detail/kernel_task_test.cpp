#include "bench/plan/families.h"
#include "bench/tasks/task.h"
#include "bench/truth/truth.h"
#include "kernels/primitives/ray.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

TEST(KernelTasks, HaveKernelsAndEachNameOnce) {
    for (const Task* task : tasks()) {
        EXPECT_EQ(task->kernels().empty(), task->scenes() != SceneKind::cases) << task->name();
        std::set<std::string_view> names;
        for (const KernelInfo& kernel : task->kernels()) {
            EXPECT_TRUE(names.insert(kernel.name).second) << kernel.name << " twice";
            EXPECT_EQ(kernel.family, task->name()) << kernel.name;
        }
    }
}

/// Two queries answer each case, and the same.
void expect_steady(const Scene& scene, const Task& task, const KernelInfo& kernel) {
    const ContenderEntry contender = task.kernel_contender(kernel.name);
    EXPECT_EQ(contender.promise, kernel.promise);
    EXPECT_FALSE(contender.is_peer);
    const Job job{&scene, &task};
    ASSERT_EQ(contender.unsupported(job), std::nullopt);
    const auto instance = contender.make(job);
    const auto first = task.make_answers(), second = task.make_answers();
    instance->build();
    instance->query(*first);
    instance->query(*second);
    EXPECT_EQ(first->size(), n_cases(scene.cases));
    EXPECT_EQ(task.hash(*first), task.hash(*second));
    const auto truth = task.make_truth(scene, 2);
    EXPECT_EQ(truth->judge(*first, contender).kernel->false_pos,
              truth->judge(*second, contender).kernel->false_pos);
    auto& cases = dynamic_cast<CaseTruth&>(*truth);
    for (std::size_t i = 0; i < n_cases(scene.cases); ++i)
        EXPECT_EQ(cases.answer_text(*first, i), cases.answer_text(*second, i));
}

TEST(KernelTasks, AnswerEveryCaseTheSameTwice) {
    for (const HardCaseFamily& family : hard_case_families()) {
        if (family.reads_file)
            continue;
        HardCaseSpec spec;
        spec.n = 21; // not a multiple of any number of lanes
        spec.scale = std::clamp(0, family.scale_min, family.scale_max);
        Scene scene;
        scene.cases = make_cases(family, spec);
        for (const Task* task : tasks())
            if (task->scenes() == SceneKind::cases && task->fits(scene.cases))
                for (const KernelInfo& kernel : task->kernels()) {
                    SCOPED_TRACE(testing::Message()
                                 << family.name << " " << task->name() << " " << kernel.name);
                    expect_steady(scene, *task, kernel);
                }
    }
}

TEST(KernelTasks, AFanGivesTheNearestOfItsHits) {
    Scene scene;
    RayCases cases;
    cases.triangles = {{{9, 9, 9}, {9, 9, 9}, {9, 9, 9}}, // of another case
                       {{0, 0, 3}, {1, 0, 3}, {0, 1, 3}},
                       {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
                       {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}};
    RayCase c;
    c.ray = {{.25f, .25f, 0}, {0, 0, 1}};
    c.first = 1;
    c.count = 3;
    cases.rays = {c};
    scene.cases = cases;
    const Task& task = *find_task("ray_triangle");
    for (const KernelInfo& kernel : task.kernels()) {
        const auto instance = task.kernel_contender(kernel.name).make(Job{&scene, &task});
        AnswerList<RayHit> answers;
        instance->query(answers);
        ASSERT_EQ(answers.list.size(), 1u);
        EXPECT_EQ(answers.list[0].triangle, 2u) << kernel.name;
        EXPECT_EQ(answers.list[0].t, 1) << kernel.name;
    }
}

TEST(KernelTasks, NameUnknownKernelsAndRefuseThreads) {
    const Task& task = *find_task("ray_triangle");
    try {
        task.kernel_contender("watertigt");
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), HasSubstr("did you mean 'watertight'"));
    }
    EXPECT_THROW(find_task("pairs")->kernel_contender("watertight"), std::invalid_argument);
    const ContenderEntry kernel = task.kernel_contender("watertight");
    Scene scene;
    EXPECT_NE(kernel.unsupported(Job{&scene, &task, "serial", 1}), std::nullopt); // no cases
    scene.cases = RayCases{};
    EXPECT_EQ(kernel.unsupported(Job{&scene, &task, "serial", 1}), std::nullopt);
    EXPECT_NE(kernel.unsupported(Job{&scene, &task, "tbb", 2}), std::nullopt);
    EXPECT_NE(kernel.unsupported(Job{&scene, find_task("ray_box")}), std::nullopt);
}

} // namespace
} // namespace boxwood::bench
