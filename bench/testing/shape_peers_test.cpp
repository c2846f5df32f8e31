/// Peers of convex shapes see the shapes that are meant: their answers are right.

#include "bench/plan/families.h"
#include "bench/tasks/contender.h"
#include "bench/tasks/task.h"
#include "bench/truth/truth.h"
#include "scenes/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace boxwood::bench {
namespace {

/// Of 100 pairs of each two kinds: libccd is off by more than its tolerance on a few of them.
void expect_right(const char* task_name, int per_cent_overlapping) {
    const Task& task = *find_task(task_name);
    std::size_t answered = 0;
    for (const HardCaseFamily* family : families_of("all", task)) {
        if (family->panel != Panel::generic || family->name == "deep_shapes")
            continue; // of deep ones peers are often wrong
        SceneSpec spec{.generator = std::string(family->name), .n = 100};
        if (!family->k_meaning.empty())
            spec.k = per_cent_overlapping;
        const Scene scene = make_scene(spec);
        const auto truth = task.make_truth(scene, 1);
        for (const Peer& peer : peers())
            for (const ContenderEntry& entry : peer.contenders) {
                if (std::ranges::none_of(
                        entry.answers, [&](const Answering& one) { return one.task == task_name; }))
                    continue;
                const Job job{&scene, &task, "serial", 1};
                if (entry.unsupported(job))
                    continue;
                ++answered;
                const auto contender = entry.make(job);
                const auto answers = task.make_answers();
                contender->build();
                contender->query(*answers);
                const auto row = truth->judge(*answers, entry).kernel.value();
                EXPECT_GT(row.n, 90u) << family->name << ", " << entry.name;
                EXPECT_LE(row.false_pos + row.false_neg + row.maybe, 10u)
                    << family->name << ", " << entry.name;
            }
    }
    if (answered == 0)
        GTEST_SKIP() << "none of FCL, Coal and Bullet is installed";
}

TEST(ShapePeers, SayWhetherShapesTouch) { expect_right("shape_collide", 50); }
TEST(ShapePeers, SayHowFarApartShapesAre) { expect_right("shape_distance", 0); }
TEST(ShapePeers, SayHowDeepShapesAre) { expect_right("signed_shape_distance", 100); }

} // namespace
} // namespace boxwood::bench
