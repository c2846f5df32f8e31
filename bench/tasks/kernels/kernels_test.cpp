#include "bench/tasks/kernels/kernels.h"

#include "bench/plan/families.h"
#include "bench/truth/judging/judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

std::size_t answers_in(const Answers& a) {
    return a.verdicts.size() + a.distances.size() + a.impacts.size() + a.hits.size() +
           a.boxes.size();
}

TEST(Rungs, EveryKernelAskHasSomeAndEachWordOnce) {
    for (const AskEntry& entry : asks()) {
        EXPECT_EQ(rungs(entry.task).empty(), !is_kernel_ask(entry.task)) << entry.name;
        std::set<std::string_view> words;
        for (const KernelInfo& rung : rungs(entry.task)) {
            EXPECT_TRUE(words.insert(rung.name).second) << rung.name << " twice";
            EXPECT_EQ(rung.family, entry.name) << rung.name;
        }
    }
}

TEST(Rungs, AnswerEveryCaseTheSameTwice) {
    for (const HardCaseFamily& family : hard_case_families()) {
        Scene scene;
        scene.cases = sample_of(family);
        if (family.reads_file)
            continue;
        HardCaseSpec spec;
        spec.n = 21; // not a multiple of any number of lanes
        spec.scale = std::clamp(0, family.scale_min, family.scale_max);
        scene.cases = make_cases(family, spec);
        for (const AskEntry& entry : asks())
            if (is_kernel_ask(entry.task) && fits(scene.cases, entry.task))
                for (const KernelInfo& rung : rungs(entry.task)) {
                    SCOPED_TRACE(testing::Message()
                                 << family.name << " " << entry.name << " " << rung.name);
                    const ContenderEntry contender = rung_contender(entry.task, rung.name);
                    EXPECT_EQ(contender.promise, rung.promise);
                    EXPECT_FALSE(contender.is_peer);
                    const Job job{&scene, entry.task};
                    ASSERT_EQ(contender.unsupported(job), std::nullopt);
                    const auto instance = contender.make(job);
                    Answers first, second;
                    instance->build();
                    instance->query(first);
                    instance->query(second);
                    EXPECT_EQ(answers_in(first), n_cases(scene.cases));
                    const auto judge = make_judge(scene, entry.task, 2);
                    EXPECT_EQ(judge->judge(first, contender).kernel.false_pos,
                              judge->judge(second, contender).kernel.false_pos);
                    for (std::size_t i = 0; i < n_cases(scene.cases); ++i)
                        EXPECT_EQ(judge->answer_text(first, i), judge->answer_text(second, i));
                }
    }
}

TEST(Rungs, AFanGivesTheNearestOfItsHits) {
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
    for (const KernelInfo& rung : rungs(Ask::ray_triangle)) {
        const auto instance =
            rung_contender(Ask::ray_triangle, rung.name).make(Job{&scene, Ask::ray_triangle});
        Answers answers;
        instance->query(answers);
        ASSERT_EQ(answers.hits.size(), 1u);
        EXPECT_EQ(answers.hits[0].triangle, 2u) << rung.name;
        EXPECT_EQ(answers.hits[0].t, 1) << rung.name;
    }
}

TEST(Rungs, NameUnknownWordsAndRefuseThreads) {
    try {
        rung_contender(Ask::ray_triangle, "watertigt");
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), HasSubstr("did you mean 'watertight'"));
    }
    const ContenderEntry rung = rung_contender(Ask::ray_triangle, "watertight");
    Scene scene;
    EXPECT_NE(rung.unsupported(Job{&scene, Ask::ray_triangle, "tbb", 2}), std::nullopt);
    EXPECT_NE(rung.unsupported(Job{&scene, Ask::ray_box}), std::nullopt);
}

} // namespace
} // namespace boxwood::bench
