/// A task that no other file knows: adding one is one file (and one name in tasks/registry.cpp,
/// which add_task stands for here).

#include "bench/analysis/analyse.h"
#include "bench/analysis/screen.h"
#include "bench/commands/show.h"
#include "bench/io/bad_input.h"
#include "bench/plan/plan.h"
#include "bench/plan/scenes.h"
#include "bench/running/prepare.h"
#include "bench/running/round.h"
#include "bench/tasks/detail/tree_task.h"
#include "bench/tasks/task.h"
#include "bench/truth/truth.h"
#include "kernels/testing/complaint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace boxwood::bench {
namespace {

/// For each point how many boxes contain it.
using Depths = std::vector<std::uint32_t>;

class CountBoxes final : public Contender {
  public:
    CountBoxes(const Job& job, bool forgets_half)
        : scene_(*job.scene), first_(forgets_half ? scene_.boxes.size() / 2 : 0) {}
    void build() override { boxes_ = scene_.boxes; }
    void query(Answers& answers) override {
        Depths& depths = list_of<std::uint32_t>(answers);
        depths.assign(scene_.points.size(), 0);
        for (std::size_t i = 0; i < depths.size(); ++i)
            for (std::size_t b = first_; b < boxes_.size(); ++b)
                depths[i] += boxes_[b].contains(scene_.points[i]);
    }

  private:
    const Scene& scene_;
    std::vector<Aabb<float>> boxes_;
    std::size_t first_;
};

class DepthTruth final : public Truth {
  public:
    explicit DepthTruth(const Scene& scene) {
        for (const Vec3<float> p : scene.points)
            depths_.push_back(static_cast<std::uint32_t>(std::ranges::count_if(
                scene.boxes, [&](const Aabb<float>& box) { return box.contains(p); })));
    }
    Judgement judge(const Answers& answers, const ContenderEntry&) override {
        Judgement judgement;
        judgement.check.oracle = "two_loops";
        judgement.check.n_checked = judgement.check.n_got = answers.size();
        judgement.check.n_expected = depths_.size();
        judgement.status =
            list_of<std::uint32_t>(answers) == depths_ ? Status::exact : Status::wrong;
        return judgement;
    }

  private:
    Depths depths_;
};

class PointDepths final : public Task {
  public:
    std::string_view name() const override { return "point_depths"; }
    std::string title() const override { return "depth of points"; }
    std::string_view summary() const override { return "for each point how many boxes contain it"; }
    std::vector<std::string_view> keys() const override {
        return {"scene", "n", "overlaps", "depth_points", "ways", "executors", "threads"};
    }
    SceneKind scenes() const override { return SceneKind::still; }
    void expand(const BlockReader& block, AddCell add) const override {
        std::vector<ContenderEntry> ours;
        for (const std::string& way : block.names("ways", {"right", "forgetful"}, {"right"})) {
            ContenderEntry& entry = ours.emplace_back();
            entry.name = "count." + way;
            entry.library = "boxwood";
            entry.is_peer = false;
            entry.precision = "f32";
            entry.answers = {{std::string(name()), [way](const Job& job) {
                                  return std::make_unique<CountBoxes>(job, way == "forgetful");
                              }}};
        }
        for (SceneSpec scene : still_scenes(block)) {
            scene.n_points = block.integer("depth_points", 1, 1000).value_or(10);
            add_cells(block, scene, ours, {}, add);
        }
    }
    std::uint64_t n_queries(const Scene& scene) const override { return scene.points.size(); }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<std::uint32_t>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        std::uint64_t hash = answers.size();
        for (const std::uint32_t depth : list_of<std::uint32_t>(answers))
            hash = (hash ^ depth) * 0x9e3779b97f4a7c15u;
        return hash;
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned) const override {
        return std::make_unique<DepthTruth>(scene);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work*) const override {
        std::uint64_t sum = 0;
        for (const std::uint32_t depth : list_of<std::uint32_t>(answers))
            sum += depth;
        return {{"containing", sum}};
    }
};

const Task& point_depths() {
    static const PointDepths task;
    static const bool added = [] {
        add_task(task);
        return true;
    }();
    (void)added;
    return task;
}

Plan plan_of(const std::string& keys) {
    point_depths();
    return make_plan("rounds = 2\nmin_time_ms = 0.1\n[[cells]]\nscene = \"uniform\"\nn = 200\n"
                     "overlaps = 50\ntask = \"point_depths\"\n" +
                         keys,
                     "added.toml", {});
}

std::string refusal(const std::string& keys) {
    return complaint_of<BadInput>([&] { plan_of(keys); });
}

TEST(AddedTask, IsPlannedCheckedTimedAndFoundInTheResults) {
    const Plan plan =
        plan_of("depth_points = 70\nways = [\"right\", \"forgetful\"]\nthreads = [1, 2]\n");
    ASSERT_EQ(plan.cells.size(), 4u);
    EXPECT_EQ(plan.cells[0].name,
              "uniform_overlaps50_points/n200-s1/point_depths/count.right/f32/serial-1");

    const Report silent = [](std::size_t, std::size_t, const std::string&) {};
    results::Env env;
    env.env_hash = "machine";
    const results::Results prepared = prepare(plan, env, {}, silent);
    ASSERT_EQ(prepared.checks.size(), 4u);
    for (const results::Check& check : prepared.checks) {
        const results::Cell& cell = prepared.cells[check.cell_id];
        EXPECT_EQ(cell.task, "point_depths");
        EXPECT_EQ(cell.n_queries, 70u);
        EXPECT_EQ(check.oracle, "two_loops");
        const bool is_right = cell.name.find("count.right") != std::string::npos;
        EXPECT_EQ(check.status, is_right ? Status::exact : Status::wrong) << cell.name;
    }
    EXPECT_GT(std::ranges::find(prepared.counters, "containing", &results::Counter::counter)->value,
              70u);

    std::vector<results::Results> parts{prepared};
    for (const unsigned round : {0u, 1u}) {
        const results::Results& timed =
            parts.emplace_back(run_round(plan, prepared, round, silent));
        std::map<results::Phase, std::set<std::uint32_t>> cells_of_phase;
        for (const results::Sample& sample : timed.samples) {
            EXPECT_GT(sample.wall_ns, 0);
            EXPECT_EQ(sample.flags & results::wrong_answer, 0u); // the same answer as checked
            cells_of_phase[sample.phase].insert(sample.cell_id);
        }
        EXPECT_EQ(cells_of_phase[results::Phase::build].size(), 4u);
        EXPECT_EQ(cells_of_phase[results::Phase::query].size(), 4u);
    }

    results::Results merged = results::merge(parts);
    analyse(merged);
    ASSERT_EQ(merged.tasks.size(), 1u);
    EXPECT_EQ(merged.health[0].wrong_ours, 2u);
    EXPECT_THAT(all_text(merged), testing::HasSubstr("200 items, point_depths, 2 threads"));
    EXPECT_THAT(screen_text(merged), testing::HasSubstr("4 answers checked: 2 of ours wrong"));
}

TEST(AddedTask, HasKeysOfItsOwn) {
    using testing::HasSubstr;
    EXPECT_EQ(find_task("point_depths"), &point_depths());
    EXPECT_THAT(refusal("depth_pionts = 5\n"), HasSubstr("'depth_points'"));
    EXPECT_THAT(refusal("depth_points = 5000\n"), HasSubstr("added.toml:8: depth_points = 5000"));
    EXPECT_THAT(refusal("ways = \"rihgt\"\n"), HasSubstr("'right'"));
    EXPECT_THAT(refusal("builders = \"median\"\n"), HasSubstr("builders is for the tasks pairs"));
    try {
        make_plan("[[cells]]\nscene = \"uniform\"\ntask = \"pairs\"\nbuilders = \"median\"\n"
                  "ways = \"right\"\n",
                  "added.toml", {});
        FAIL();
    } catch (const BadInput& error) {
        EXPECT_THAT(error.what(), HasSubstr("ways is for the task point_depths"));
    }
}

} // namespace
} // namespace boxwood::bench
