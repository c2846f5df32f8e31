/// The preparation and the rounds, with contenders made for the purpose.

#include "bench/running/round.h"

#include "bench/running/calibration.h"
#include "bench/running/inputs.h"
#include "bench/running/prepare.h"
#include "bench/tasks/task.h"
#include "scenes/moving/frames.h"
#include "trees/dynamic/update.h"
#include "trees/queries/sinks.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>
#include <thread>

namespace boxwood::bench {
namespace {

/// What a made-up contender does wrong.
enum class Fault {
    none,
    loses_a_pair,
    loses_a_pair_later,
    loses_a_pair_elsewhere, ///< on another input than the first
    throws,
    throws_elsewhere,
    cannot,
    counts_otherwise
};

int alive = 0, max_alive = 0;

/// All pairs of four boxes by comparing each with each.
class Made final : public Contender {
  public:
    Made(const Job& job, Fault fault, int& queries)
        : scene_(*job.scene), fault_(fault), queries_(queries) {
        max_alive = std::max(max_alive, ++alive);
    }
    ~Made() override { --alive; }
    void build() override { std::this_thread::sleep_for(std::chrono::microseconds(50)); }
    void query(Answers& answers) override {
        ++queries_;
        const bool is_elsewhere = scene_.spec.seed != 1;
        if (fault_ == Fault::throws || (fault_ == Fault::throws_elsewhere && is_elsewhere))
            throw std::runtime_error("no more\nmemory");
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        for (std::uint32_t b = 0; b < scene_.boxes.size(); ++b)
            for (std::uint32_t a = 0; a < b; ++a)
                if (overlaps(scene_.boxes[a], scene_.boxes[b]))
                    pairs.push_back({a, b});
        if (fault_ == Fault::loses_a_pair || (fault_ == Fault::loses_a_pair_later && is_late) ||
            (fault_ == Fault::loses_a_pair_elsewhere && is_elsewhere))
            pairs.pop_back();
    }
    std::optional<Work> counted_query(Answers& answers) override {
        query(answers);
        if (fault_ == Fault::counts_otherwise)
            list_of<Pair>(answers).pop_back();
        return Work{5, 6, 0, answers.size(), 2};
    }
    std::optional<StructureInfo> structure() const override { return StructureInfo{123, nullptr}; }

    static inline bool is_late = false; ///< the preparation is over

  private:
    const Scene& scene_;
    Fault fault_;
    int& queries_;
};

struct RoundTest : testing::Test {
    Plan plan;
    std::map<std::string, int> queries;
    results::Env env;
    std::vector<std::string> reported;

    RoundTest() {
        plan.min_time_ms = 0.2;
        plan.sweep_hash = "hash";
        env.env_hash = "machine";
        Made::is_late = false;
        alive = max_alive = 0;
    }

    void add(const std::string& name, Fault fault, bool is_peer = false) {
        PlannedCell cell;
        cell.name = name;
        cell.scene.generator = "four_link";
        cell.scene.n = 4;
        cell.contender.name = name;
        cell.contender.library = is_peer ? "brute_force" : "boxwood";
        cell.contender.is_peer = is_peer;
        cell.contender.cannot = [fault](const Job&) -> std::optional<std::string> {
            return fault == Fault::cannot ? std::optional("has no arms") : std::nullopt;
        };
        cell.contender.answers = {{"pairs", [this, name, fault](const Job& job) {
                                       return std::make_unique<Made>(job, fault, queries[name]);
                                   }}};
        cell.task = find_task("pairs");
        cell.executor = "serial";
        plan.cells.push_back(cell);
    }

    Report report() {
        return
            [this](std::size_t, std::size_t, const std::string& cell) { reported.push_back(cell); };
    }

    results::Results prepared(const std::set<std::string>& skip = {}) {
        return prepare(plan, env, skip, report());
    }

    /// As if all cells had taken the same time.
    static results::Results evened(results::Results r) {
        Calibrations all = calibrations_of(r.texts.at("calibration"));
        for (auto& [name, calibration] : all)
            calibration = {2, 2, 1e5, 1e5};
        r.texts["calibration"] = to_text(all);
        return r;
    }

    static const results::Check* check_of(const results::Results& r, std::string_view name) {
        for (const results::Cell& cell : r.cells)
            for (const results::Check& check : r.checks)
                if (cell.name == name && check.cell_id == cell.cell_id)
                    return &check;
        return nullptr;
    }
};

TEST_F(RoundTest, PreparationChecksCountsAndCalibrates) {
    add("right", Fault::none);
    add("wrong", Fault::loses_a_pair);
    add("throws", Fault::throws);
    add("cannot", Fault::cannot);
    add("skipped", Fault::none);
    add("counts", Fault::counts_otherwise);
    const results::Results r = prepared({"skipped"});

    ASSERT_EQ(r.cells.size(), 6u);
    EXPECT_EQ(r.scenes.size(), 1u);
    EXPECT_EQ(r.variants.size(), 6u);
    EXPECT_TRUE(r.samples.empty());
    EXPECT_EQ(check_of(r, "right")->status, results::Status::exact);
    EXPECT_NE(check_of(r, "right")->result_hash, 0u);
    EXPECT_EQ(check_of(r, "wrong")->status, results::Status::wrong);
    EXPECT_EQ(check_of(r, "wrong")->missing, 1u);
    EXPECT_EQ(check_of(r, "throws")->status, results::Status::wrong);
    EXPECT_EQ(check_of(r, "throws")->witness, "threw: no more\nmemory");
    EXPECT_EQ(check_of(r, "cannot")->status, results::Status::unsupported);
    EXPECT_EQ(check_of(r, "cannot")->witness, "has no arms");
    EXPECT_EQ(check_of(r, "skipped"), nullptr);
    EXPECT_EQ(queries["skipped"], 0);
    EXPECT_EQ(check_of(r, "counts")->status, results::Status::wrong);

    const Calibrations calibrations = calibrations_of(r.texts.at("calibration"));
    EXPECT_EQ(calibrations.size(), 3u); // wrong ones are timed too; nobody ranks them
    const Calibration& c = calibrations.at("right");
    EXPECT_GE(c.build_ns, 50e3);
    EXPECT_LE(c.build_iterations, 4u);
    EXPECT_GT(c.query_iterations, 10u);

    std::map<std::string, std::uint64_t> counters;
    for (const results::Counter& counter : r.counters)
        if (counter.cell_id == 0)
            counters[counter.counter] = counter.value;
    EXPECT_EQ(
        counters,
        (std::map<std::string, std::uint64_t>{
            {"pairs", 2}, {"bytes", 123}, {"node_visits", 5}, {"box_tests", 6}, {"stack_max", 2}}));
}

TEST_F(RoundTest, RoundsTakeTurnsAtTheInputs) {
    plan.inputs = 3;
    add("right", Fault::none);
    add("wrong", Fault::loses_a_pair_elsewhere);
    add("throws", Fault::throws_elsewhere);
    add("file", Fault::loses_a_pair_elsewhere); // of one input
    for (PlannedCell& cell : plan.cells) {
        cell.scene.generator = "uniform";
        cell.scene.n = 40;
    }
    plan.cells.back().scene.generator = "mesh";
    const std::string mesh = testing::TempDir() + "two_triangles.obj";
    plan.cells.back().scene.file = mesh;
    std::ofstream(mesh) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 3 4\n";
    const results::Results p = prepared();
    const InputAnswers answers = input_answers_of(p.texts.at("inputs"));
    EXPECT_NE(answers.at({"right", 0}), answers.at({"right", 2}));
    EXPECT_EQ(check_of(p, "right")->status, results::Status::exact);
    EXPECT_EQ(check_of(p, "right")->n_got,
              answers.at({"right", 0}).n + answers.at({"right", 1}).n + answers.at({"right", 2}).n);
    EXPECT_EQ(check_of(p, "wrong")->status, results::Status::wrong);
    EXPECT_EQ(check_of(p, "wrong")->missing, 2u);
    EXPECT_TRUE(check_of(p, "wrong")->witness.starts_with("on input 1: "))
        << check_of(p, "wrong")->witness;
    EXPECT_EQ(check_of(p, "throws")->status, results::Status::wrong);
    EXPECT_EQ(check_of(p, "throws")->witness, "threw on input 1: no more\nmemory");
    EXPECT_EQ(check_of(p, "file")->status, results::Status::exact);
    std::vector<std::uint32_t> inputs;
    for (const unsigned round : {0u, 1u, 2u, 5u}) {
        const results::Results r = run_round(plan, p, round, report());
        inputs.push_back(r.shards.at(0).input);
        for (const results::Sample& sample : r.samples)
            EXPECT_FALSE(sample.flags & results::wrong_answer) << r.cells[sample.cell_id].name;
    }
    EXPECT_EQ(inputs, (std::vector<std::uint32_t>{0, 1, 2, 2}));
}

TEST_F(RoundTest, ARoundTimesEveryCellOnceAndTheAaCellTwice) {
    for (const char* name : {"a", "b", "c", "d", "e"})
        add(name, Fault::none);
    add("throws", Fault::throws);
    const results::Results p = evened(prepared());
    const std::set<std::string> twins = choose_twins(p, calibrations_of(p.texts.at("calibration")));
    ASSERT_EQ(twins.size(), 1u);
    const std::string aa = *twins.begin();
    max_alive = 0;
    std::set<std::vector<std::uint32_t>> orders;
    for (const unsigned round : {0u, 1u, 2u, 0u}) {
        reported.clear();
        queries.clear();
        const results::Results r = run_round(plan, p, round, report());
        EXPECT_EQ(reported.size(), 6u);
        for (const auto& [name, runs] : queries) // once to warm up, twice as calibrated
            EXPECT_EQ(runs, (name == aa ? 2 : 1) * 3);
        ASSERT_EQ(r.shards.size(), 1u);
        EXPECT_EQ(r.shards[0].round, round);
        EXPECT_EQ(r.sweep_hash, "hash");
        ASSERT_EQ(r.samples.size(), 2u * 6);
        std::map<std::string, int> times;
        std::vector<std::uint32_t> order;
        for (std::size_t i = 0; i < r.samples.size(); ++i) {
            const results::Sample& s = r.samples[i];
            EXPECT_EQ(s.position, i);
            EXPECT_EQ(s.round, round);
            EXPECT_EQ(s.phase, i % 2 ? results::Phase::query : results::Phase::build);
            EXPECT_EQ(s.cell_id, r.samples[i & ~std::size_t{1}].cell_id);
            EXPECT_FALSE(s.flags & results::wrong_answer);
            const std::string& name = r.cells[s.cell_id].name;
            times[name + (s.flags & results::aa_twin ? "'" : "")]++;
            const Calibration c = calibrations_of(p.texts.at("calibration")).at(name);
            EXPECT_EQ(s.iterations, i % 2 ? c.query_iterations : c.build_iterations);
            EXPECT_GT(s.wall_ns, i % 2 ? 0 : 50e3); // the build sleeps for 50 us
            EXPECT_LT(s.wall_ns, 1e9);
            EXPECT_GE(s.cpu_ns, 0);
            order.push_back(s.cell_id);
        }
        EXPECT_EQ(times.size(), 6u);
        EXPECT_EQ(times[aa], 2);
        EXPECT_EQ(times[aa + "'"], 2);
        orders.insert(order);
    }
    EXPECT_EQ(orders.size(), 3u); // another order in each round, the same one again for round 0
    EXPECT_EQ(max_alive, 1);
    EXPECT_EQ(alive, 0);
}

TEST_F(RoundTest, AnotherAnswerThanTheCheckedOneIsFlagged) {
    add("steady", Fault::none);
    add("later", Fault::loses_a_pair_later);
    const results::Results p = prepared();
    Made::is_late = true;
    for (const results::Sample& s : run_round(plan, p, 0, report()).samples)
        EXPECT_EQ((s.flags & results::wrong_answer) != 0,
                  s.cell_id == 1 && s.phase == results::Phase::query);
}

TEST_F(RoundTest, ACrashedCellIsOutAndSaysWhy) {
    add("a", Fault::none);
    add("b", Fault::none);
    results::Results p = prepared({"b"});
    EXPECT_TRUE(mark_crashed(p, "b", "crashed: signal 11 in the preparation"));
    EXPECT_TRUE(mark_crashed(p, "a", "crashed: signal 6 in round 2"));
    EXPECT_FALSE(mark_crashed(p, "a", "crashed: signal 6 in round 2"));
    for (const char* name : {"a", "b"}) {
        EXPECT_EQ(check_of(p, name)->status, results::Status::wrong);
        EXPECT_TRUE(check_of(p, name)->witness.starts_with("crashed: signal"));
    }
    EXPECT_EQ(p.checks.size(), 2u);
    EXPECT_TRUE(run_round(plan, p, 0, report()).samples.empty());
}

TEST_F(RoundTest, WhatAContenderThrowsInARoundComesOut) {
    add("a", Fault::none);
    const results::Results p = prepared();
    plan.cells[0].contender.answers[0].make = [this](const Job& job) {
        return std::make_unique<Made>(job, Fault::throws, queries["a"]);
    };
    EXPECT_THROW(run_round(plan, p, 0, report()), std::runtime_error);
}

TEST_F(RoundTest, KernelsAreJudgedAndHaveAQueryAlone) {
    PlannedCell cell;
    cell.scene.generator = "generic_triangles";
    cell.scene.n = 20;
    cell.executor = "serial";
    for (const char* name : {"triangle_triangle", "triangle_distance"}) {
        cell.task = find_task(name);
        cell.contender = cell.task->kernel_contender("rational");
        cell.name = name;
        plan.cells.push_back(cell);
    }
    add("tree", Fault::none);
    const results::Results r = prepared();
    ASSERT_EQ(r.kernels.size(), 2u);
    EXPECT_EQ(r.kernels[0].family, "generic_triangles");
    EXPECT_EQ(r.kernels[0].n, 20u);
    EXPECT_EQ(r.kernels[0].status, results::Status::exact);
    EXPECT_GT(r.kernels[0].ns_per_call, 0);
    EXPECT_EQ(r.kernels[1].cell_id, 1u);
    EXPECT_FALSE(r.conditions.empty());
    EXPECT_EQ(r.conditions[0].cell_id, 1u);
    EXPECT_EQ(check_of(r, "triangle_triangle")->status, results::Status::exact);
    EXPECT_EQ(r.cells[0].n_items, 20u);
    EXPECT_EQ(r.cells[0].n_queries, 20u);
    EXPECT_EQ(r.variants.at(r.cells[0].variant_id).predicates, "exact");

    const results::Results round = run_round(plan, r, 0, report());
    std::multiset<std::string> phases;
    for (const results::Sample& sample : round.samples) {
        phases.insert(fmt::format("{} {}", sample.cell_id, to_string(sample.phase)));
        EXPECT_EQ(sample.flags & results::wrong_answer, 0u) << to_string(sample.phase);
    }
    // The A/A cell, one of ours, is there twice.
    EXPECT_EQ(phases.count("0 build") + phases.count("1 build"), 0u);
    EXPECT_GE(phases.count("0 query"), 1u);
    EXPECT_GE(phases.count("1 query"), 1u);
    EXPECT_GE(phases.count("2 build"), 1u);
    EXPECT_EQ(phases.count("2 build"), phases.count("2 query"));
}

/// A policy that can count its frames, cannot, or answers otherwise when it counts.
class Follower final : public Contender {
  public:
    Follower(std::unique_ptr<Contender> policy, Fault fault)
        : policy_(std::move(policy)), fault_(fault) {}
    void build() override { policy_->build(); }
    void query(Answers& answers) override { policy_->query(answers); }
    void update(const Frame& frame) override {
        policy_->update(frame);
        ++frame_;
    }
    std::optional<Work> counted_query(Answers& answers) override {
        if (fault_ == Fault::cannot)
            return std::nullopt;
        const std::optional<Work> work = policy_->counted_query(answers);
        if (fault_ == Fault::counts_otherwise && Made::is_late && frame_ == 2)
            list_of<Pair>(answers).pop_back();
        return work;
    }
    std::optional<StructureInfo> structure() const override {
        return fault_ == Fault::cannot ? std::nullopt : policy_->structure();
    }

  private:
    std::unique_ptr<Contender> policy_;
    Fault fault_;
    int frame_ = 0;
};

TEST_F(RoundTest, Round0CountsTheFramesOfMovingScenes) {
    const std::vector<std::string> policies{"auto",     "refit", "cached",
                                            "reinsert", "merge", "rebuild"};
    plan = make_plan("rounds = 2\nmin_time_ms = 1\n[[cells]]\ntask = \"moving_pairs\"\n"
                     "scene = \"broadmark_brownian\"\nn = 700\nframes = 5\n"
                     "updates = [\"auto\", \"refit\", \"cached\", \"reinsert\", \"merge\", "
                     "\"rebuild\"]\n",
                     "test.toml", {});
    ASSERT_EQ(plan.cells.size(), policies.size());
    for (const Fault fault : {Fault::cannot, Fault::counts_otherwise}) {
        PlannedCell cell = plan.cells[1];
        cell.name = fault == Fault::cannot ? "cannot" : "counts_otherwise";
        cell.contender.answers[0].make = [fault, policy = plan.cells[1].contender](const Job& job) {
            return std::make_unique<Follower>(policy.make(job), fault);
        };
        plan.cells.push_back(cell);
    }
    const results::Results ready = prepared();
    Made::is_late = true;
    const results::Results counted = run_round(plan, ready, 0, report()),
                           later = run_round(plan, ready, 1, report());
    ASSERT_EQ(counted.frames.size(), 5 * plan.cells.size());
    std::map<std::pair<std::uint32_t, std::uint32_t>, const results::FrameRow*> rows;
    for (const results::FrameRow& row : counted.frames)
        rows[{row.cell_id, row.frame}] = &row;
    for (std::uint32_t cell = 0; cell < policies.size(); ++cell) {
        const SceneSpec& spec = plan.cells[cell].scene;
        Frames frames(spec.moving);
        const std::unique_ptr<Updater> updater = find_update(policies[cell]).make({});
        updater->start(make_scene(spec).boxes, serial());
        for (std::uint32_t f = 0; const Frame* const frame = frames.next(); ++f) {
            updater->update(frame->boxes, frame->moved, serial());
            CountPairs pairs;
            const Work work = updater->self_pairs_counted(pairs);
            const results::FrameRow& row = *rows.at({cell, f});
            EXPECT_EQ(row.box_tests, work.box_tests) << policies[cell] << ", frame " << f;
            EXPECT_EQ(row.pairs, work.answers);
            EXPECT_EQ(row.sah, updater->sah());
            EXPECT_GT(row.sah, 16);
        }
    }
    for (std::uint32_t f = 0; f < 5; ++f) {
        EXPECT_EQ(rows.at({policies.size(), f})->box_tests, results::no_count);
        EXPECT_TRUE(std::isnan(rows.at({policies.size(), f})->sah));
        EXPECT_GT(rows.at({policies.size(), f})->query_ns, 0);
    }
    for (const results::FrameRow& row : later.frames) {
        EXPECT_EQ(row.box_tests, results::no_count);
        EXPECT_TRUE(std::isnan(row.sah));
    }
    for (const results::Results* round : {&counted, &later})
        for (const results::Sample& sample : round->samples)
            EXPECT_EQ((sample.flags & results::wrong_answer) != 0,
                      round == &counted && sample.cell_id == policies.size() + 1 &&
                          sample.phase != results::Phase::build &&
                          !(sample.flags & results::aa_twin));
}

TEST_F(RoundTest, ACellWithFewerRoundsIsNotInTheLaterOnesAndNoTwin) {
    for (const char* name : {"a", "b", "c", "d", "always"})
        add(name, Fault::none);
    plan.rounds = 2;
    for (std::size_t i = 0; i < 4; ++i)
        plan.cells[i].rounds = 1;
    const results::Results ready = evened(prepared());
    std::set<std::uint32_t> timed[2], twins[2];
    for (const unsigned round : {0u, 1u})
        for (const results::Sample& sample : run_round(plan, ready, round, report()).samples) {
            timed[round].insert(sample.cell_id);
            if (sample.flags & results::aa_twin)
                twins[round].insert(sample.cell_id);
        }
    EXPECT_EQ(timed[0], (std::set<std::uint32_t>{0, 1, 2, 3, 4}));
    for (const auto& cells : {timed[1], twins[0], twins[1]})
        EXPECT_EQ(cells, std::set<std::uint32_t>{4});
}

} // namespace
} // namespace boxwood::bench
