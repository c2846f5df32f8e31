#include "bench/io/bad_input.h"
#include "bench/plan/plan.h"
#include "bench/running/play.h"
#include "bench/running/prepare.h"
#include "bench/running/round.h"
#include "bench/stages/stages_contender.h"
#include "bench/tasks/task.h"
#include "bench/truth/truth.h"
#include "kernels/testing/complaint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

const Report silent = [](std::size_t, std::size_t, const std::string&) {};

Plan query_plan_of(const std::string& keys) {
    return make_plan("min_time_ms = 0.1\n[[cells]]\ntask = \"scene_queries\"\n" + keys, "x.toml",
                     {});
}

TEST(SceneQueries, ASweepChecksEveryFrameAndKeepsTheLedger) {
    const Plan plan =
        query_plan_of("scene = [\"crowd\", \"arm_in_clutter\"]\nn = 150\nframes = 4\n"
                      "stages = [\"required\", \"all_stages\"]\nwithout = \"each\"\n");
    std::set<std::string> names;
    for (const PlannedCell& cell : plan.cells)
        names.insert(cell.name);
    EXPECT_EQ(plan.cells.size(), 2u * 2 + 3 + 1);
    EXPECT_TRUE(names.contains("crowd_frames4/n150-s1/scene_queries/required.without_spawn/f32/"
                               "serial-1"));
    EXPECT_TRUE(names.contains("arm_in_clutter_frames4/n150-s1/scene_queries/all_stages/f32/"
                               "serial-1"));

    results::Env env;
    env.env_hash = "machine";
    const results::Results prepared = prepare(plan, env, {}, silent);
    ASSERT_EQ(prepared.checks.size(), plan.cells.size());
    for (const results::Check& check : prepared.checks) {
        EXPECT_EQ(check.status, results::Status::exact)
            << prepared.cells[check.cell_id].name << ": " << check.witness;
        EXPECT_EQ(check.oracle, "sweep");
    }
    ASSERT_EQ(prepared.scenes.size(), 2u);
    EXPECT_EQ(prepared.scenes[0].n_frames, 4u);
    EXPECT_EQ(prepared.scenes[0].effects, "brownian,spawn,despawn");
    EXPECT_THAT(prepared.scenes[1].queries, HasSubstr("scene_queries,pairs"));

    const results::Results round = run_round(plan, prepared, 0, silent);
    EXPECT_EQ(round.frames.size(), plan.cells.size() * 4);
    for (const results::Sample& sample : round.samples)
        EXPECT_EQ(sample.flags & results::wrong_answer, 0u);
    std::set<std::uint32_t> with_ledger;
    for (const results::EffectRow& row : round.effects) {
        with_ledger.insert(row.cell_id);
        const bool all_stages =
            round.cells[row.cell_id].name.find("all_stages") != std::string::npos;
        if (!row.required && !all_stages) {
            EXPECT_EQ(row.calls, 0u) << row.stage;
            EXPECT_EQ(row.total_ns, 0) << row.stage;
            EXPECT_EQ(row.bytes, 0u) << row.stage;
        }
        if (row.stage == "pairs") {
            EXPECT_GE(row.calls, 4u);
            EXPECT_GT(row.total_ns, 0);
        }
    }
    EXPECT_EQ(with_ledger.size(), plan.cells.size());
}

/// Plays as another contender does, but for one pair.
class LosesAPair final : public Contender {
  public:
    LosesAPair(const Job& job, std::size_t frame)
        : right_(stages_contender(Extent::required).make(job)), frame_(frame) {}
    void build() override {
        right_->build();
        at_ = 0;
    }
    void update(const Frame& frame) override { right_->update(frame); }
    void query(Answers& answers) override {
        right_->query(answers);
        auto& found = dynamic_cast<StageAnswers&>(answers);
        answers_ = *found.frame;
        if (at_++ == frame_)
            answers_.pairs.pop_back();
        found.frame = &answers_;
    }

  private:
    std::unique_ptr<Contender> right_;
    std::size_t frame_, at_ = 0;
    FrameAnswers answers_;
};

TEST(SceneQueries, ALostPairIsSeenAndNamed) {
    const Plan plan =
        query_plan_of("scene = \"popcorn\"\nn = 300\nframes = 5\nstages = \"required\"\n");
    const Scene scene = make_scene(plan.cells.at(0).scene);
    const Task& task = *find_task("scene_queries");
    const Job job{&scene, &task, "serial", 1};
    const auto truth = task.make_truth(scene, 1);
    const auto judged = [&](Contender& contender, const ContenderEntry& entry) {
        const auto answers = task.make_answers();
        std::vector<FrameTime> times(5);
        contender.build();
        play(contender, nullptr, *answers, times, [&](std::size_t index, const Frame& frame) {
            truth->note_frame(index, frame, *answers, entry);
        });
        return truth->judge(*answers, entry);
    };
    const ContenderEntry all_stages = stages_contender(Extent::all_stages);
    const Judgement right = judged(*all_stages.make(job), all_stages);
    EXPECT_EQ(right.status, Status::exact) << right.check.witness;
    EXPECT_GT(right.check.n_expected, 100u);
    LosesAPair contender(job, 2);
    const Judgement wrong = judged(contender, stages_contender(Extent::required));
    EXPECT_EQ(wrong.status, Status::wrong);
    EXPECT_EQ(wrong.check.missing, 1u);
    EXPECT_EQ(wrong.check.extra, 0u);
    EXPECT_THAT(wrong.check.witness, HasSubstr("frame 2: missing ("));
}

TEST(SceneQueries, SweepFilesSayWhatIsWrong) {
    const auto error_of = [](const std::string& keys) {
        return complaint_of<BadInput>([&] { query_plan_of(keys); });
    };
    EXPECT_THAT(error_of("scene = \"crowd\"\n"), HasSubstr("needs stages"));
    EXPECT_THAT(error_of("scene = \"crowd\"\nstages = \"all_stage\"\n"), HasSubstr("'all_stages'"));
    EXPECT_THAT(error_of("scene = \"crowd\"\nwithout = \"spwan\"\n"), HasSubstr("'spawn'"));
    EXPECT_THAT(error_of("scene = \"crowd\"\nstages = \"all_stages\"\nupdates = \"auto\"\n"),
                HasSubstr("updates is for the task moving_pairs"));
    EXPECT_THAT(error_of("scene = \"crowd\"\nstages = \"all_stages\"\npeers = \"fcl\"\n"),
                HasSubstr("peers is for the tasks "));
}

} // namespace
} // namespace boxwood::bench
