#include "bench/tasks/task.h"
#include "bench/tasks/tree_answers.h"
#include "bench/truth/truth.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace boxwood::bench {
namespace {

Scene boxes_of(std::size_t n) {
    SceneSpec spec;
    spec.generator = "uniform";
    spec.n = n;
    return make_scene(spec);
}

const Task& task() { return *find_task("build"); }

std::vector<ContenderEntry> all_contenders() {
    std::vector<ContenderEntry> all = peers_that_answer("build");
    for (const BuilderEntry& builder : builders())
        all.push_back(task().contender({std::string(builder.name), {}, "wide8", "", ""}));
    return all;
}

TEST(Build, AreExactForOursAndPeersAlsoWhenBuiltAgain) {
    for (const std::size_t n : {1u, 2u, 3u, 5000u}) {
        const Scene scene = boxes_of(n);
        const auto truth = task().make_truth(scene, 1);
        const auto answers = task().make_answers();
        for (const ContenderEntry& entry : all_contenders())
            for (const unsigned threads : {1u, 2u}) {
                const Job job{&scene, &task(), std::string(default_executor(threads)), threads};
                if (entry.unsupported(job))
                    continue;
                const auto contender = entry.make(job);
                for (int again = 0; again < 2; ++again) {
                    contender->build();
                    contender->query(*answers);
                    const Judgement judged = truth->judge(*answers, entry);
                    EXPECT_EQ(judged.status, Status::exact)
                        << entry.name << ": " << judged.check.witness;
                    EXPECT_GE(judged.check.n_got, n) << entry.name;
                    EXPECT_GT(contender->structure()->bytes, 0u);
                }
            }
    }
}

TEST(Build, AreNamedByBuilderAlone) {
    const ContenderEntry entry = task().contender({"binned_sah", {{"bins", 8}}, "binary", "", ""});
    EXPECT_EQ(entry.name, "binned_sah_bins8.tree");
    EXPECT_EQ(entry.builder, "binned_sah_bins8");
    EXPECT_TRUE(entry.layout.empty() && entry.traversal.empty());
    EXPECT_THROW(task().contender({"medain", {}, "wide8", "", ""}), std::invalid_argument);
}

TEST(Build, FaultsAreFound) {
    const Scene scene = boxes_of(100);
    const auto broken = [&](auto break_it) {
        Tree tree = make_builder("median")(scene.boxes, serial());
        break_it(tree);
        TreeAnswers answers;
        answers.tree = &tree;
        const Judgement judged = task().make_truth(scene, 1)->judge(answers, {});
        EXPECT_EQ(judged.has_faulty_tree, judged.status == Status::wrong);
        return judged;
    };
    EXPECT_EQ(broken([](Tree&) {}).status, Status::exact);
    EXPECT_EQ(broken([](Tree& t) { t.is_split = true; }).status, Status::exact);
    for (const bool split : {false, true}) {
        const auto item_lost = broken([&](Tree& t) {
            t.is_split = split;
            t.order[3] = t.order[4];
        });
        EXPECT_EQ(item_lost.status, Status::wrong);
        EXPECT_FALSE(item_lost.check.witness.empty());
        EXPECT_EQ(broken([&](Tree& t) {
                      t.is_split = split;
                      t.nodes[0].box.max.x += 1;
                  }).status,
                  Status::wrong);
        EXPECT_EQ(broken([&](Tree& t) {
                      t.is_split = split;
                      t.order[7] = 100;
                  }).status,
                  Status::wrong);
    }
}

} // namespace
} // namespace boxwood::bench
