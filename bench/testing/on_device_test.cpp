/// What the bench does with contenders on a device, on the host's model of one.

#include "bench/commands/query.h"
#include "bench/plan/plan.h"
#include "bench/running/prepare.h"
#include "bench/running/round.h"
#include "bench/tasks/task.h"
#include "trees/cuda/device/machine_on_host.h"
#include "trees/device.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

const Report silent = [](std::size_t, std::size_t, const std::string&) {};

Plan plan_of(const std::string& cells) {
    return make_plan("rounds = 2\nmin_time_ms = 0.01\nthreads = 1\n" + cells, "device.toml", {});
}
results::Results prepared(const Plan& plan) {
    results::Env env;
    env.env_hash = "machine";
    return prepare(plan, env, {}, silent);
}

const results::Check& check_of(const results::Results& results, const results::Cell& cell) {
    return *std::ranges::find(results.checks, cell.cell_id, &results::Check::cell_id);
}

/// Every cell of a device that has a form is right, and answers as the same contender on the CPU.
void expect_right(const std::string& scene, const std::string& block, std::size_t n_forms) {
    SCOPED_TRACE(block);
    const Plan plan = plan_of(
        "[[cells]]\nn = 120\nscene = \"" + scene +
        "\"\nexecutors = [\"serial\", \"cuda\", \"cuda_resident\", \"cuda_graph\"]\n" + block);
    const results::Results all = prepared(plan);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> of_cpu; // by scene and variant
    for (const results::Cell& cell : all.cells)
        if (cell.executor == "serial")
            of_cpu[{cell.scene_id, cell.variant_id}] = check_of(all, cell).result_hash;
    std::size_t right = 0;
    for (const results::Cell& cell : all.cells) {
        if (!is_device(cell.executor))
            continue;
        const results::Check& check = check_of(all, cell);
        EXPECT_THAT(cell.classes,
                    testing::EndsWith(cell.executor == "cuda"         ? "on a device"
                                      : cell.executor == "cuda_graph" ? "resident by a graph"
                                                                      : "resident"));
        if (check.status == results::Status::unsupported) {
            EXPECT_THAT(check.witness, HasSubstr("has no form for a device")) << cell.name;
            continue;
        }
        ++right;
        EXPECT_NE(check.status, results::Status::wrong) << cell.name << ": " << check.witness;
        EXPECT_EQ(check.result_hash, (of_cpu[{cell.scene_id, cell.variant_id}])) << cell.name;
    }
    EXPECT_EQ(right, n_forms);

    const results::Results timed = run_round(plan, all, 0, silent);
    const results::Shard& shard = timed.shards.at(0);
    for (const double rate :
         {shard.gpu_copy_gbs, shard.gpu_upload_gbs, shard.gpu_download_gbs, shard.gpu_launch_ns,
          shard.gpu_upload_pageable_gbs, shard.gpu_download_pageable_gbs})
        EXPECT_GT(rate, 0);
    std::map<std::uint32_t, std::set<results::Phase>> phases;
    for (const results::Sample& sample : timed.samples) {
        EXPECT_EQ(sample.flags & results::wrong_answer, 0u);
        EXPECT_GT(sample.wall_ns, 0);
        phases[sample.cell_id].insert(sample.phase);
    }
    using enum results::Phase;
    for (const auto& [id, seen] : phases)
        EXPECT_EQ(seen, all.cells[id].executor == "cuda"
                            ? (std::set{build, query, upload, device_build, device_query, download})
                            : (std::set{build, query}))
            << all.cells[id].name;
}

TEST(BenchOnDevice, TasksAnswerThereAsOnTheCpu) {
    const std::string trees = "builders = [\"hilbert\", \"lbvh\", \"ploc\", \"median\"]\n"
                              "layouts = [\"packed\", \"binary\"]\n";
    expect_right("uniform", "task = \"pairs\"\n" + trees, 9);
    expect_right("uniform", "task = \"tree_pairs\"\n" + trees, 6);
    expect_right("uniform", "task = \"points\"\nn_points = 30\n" + trees, 6);
    expect_right("uniform",
                 "task = \"regions\"\nn_points = 30\nregions = [\"boxes\", \"spheres\"]\n" + trees,
                 6);
    expect_right("uniform", "task = \"nearest\"\nn_points = 30\nk = 3\n" + trees, 2);
}

TEST(BenchOnDevice, RaysAnswerThereAsOnTheCpu) {
    const std::string rays =
        "rays = \"random\"\nn_rays = 50\nbuilders = [\"hilbert\", \"ploc\"]\n"
        "layouts = [\"packed\", \"wide8\"]\nray_order = [\"given\", \"sorted\", \"single\"]\n"
        "kernels = [\"watertight\", \"moller_trumbore_f32\", \"plucker_f32\"]\n";
    expect_right("sphere_mesh", "task = \"rays_closest\"\n" + rays, 16);
    expect_right("sphere_mesh", "task = \"rays_any\"\n" + rays, 16);
}

/// The list of every frame is that of the truth, which the preparation holds it to.
TEST(BenchOnDevice, MovingPairsFollowTheFrames) {
    const Plan plan =
        plan_of("[[cells]]\nscene = \"uniform\"\nn = 200\ntask = \"moving_pairs\"\n"
                "effects = \"drift\"\nframes = 4\n"
                "updates = [\"refit\", {name = \"rebuild\", trigger = 0}, \"cached\"]\n"
                "executors = [\"cuda\", \"cuda_resident\"]\n");
    const results::Results all = prepared(plan);
    std::map<results::Status, int> statuses;
    for (const results::Check& check : all.checks)
        ++statuses[check.status];
    EXPECT_EQ(statuses, (std::map<results::Status, int>{{results::Status::exact, 2},
                                                        {results::Status::unsupported, 4}}));
    for (const results::Sample& sample : run_round(plan, all, 0, silent).samples)
        EXPECT_EQ(sample.flags & results::wrong_answer, 0u);
}

/// After a fault a process can use no device any more: it ends, and the parent starts another.
TEST(BenchOnDevice, AFaultEndsThePreparation) {
    class Faulty final : public Contender {
        void build() override { throw DeviceError("CUDA: a kernel: an illegal memory access"); }
        void query(Answers&) override {}
    };
    Plan plan = plan_of("[[cells]]\nscene = \"uniform\"\nn = 30\ntask = \"pairs\"\n"
                        "builders = \"hilbert\"\nlayouts = \"packed\"\nexecutors = \"cuda\"\n");
    plan.cells.at(0).contender.answers.at(0).make_on_device = [](const Job&) {
        return std::make_unique<Faulty>();
    };
    EXPECT_THROW(prepared(plan), DeviceError);
}

TEST(BenchOnDevice, OutOfMemoryIsSaidAndTheOthersGoOn) {
    const Plan plan = plan_of("[[cells]]\nscene = \"uniform\"\nn = 3000\ntask = \"pairs\"\n"
                              "builders = \"hilbert\"\nlayouts = \"packed\"\n"
                              "executors = [\"cuda\", \"serial\"]\n");
    const cuda::FreeMemory little(10'000);
    const results::Results all = prepared(plan);
    ASSERT_EQ(all.checks.size(), 2u);
    const results::Check& on_device =
        check_of(all, all.cells[all.cells[0].executor == "cuda" ? 0 : 1]);
    EXPECT_EQ(on_device.status, results::Status::unsupported);
    EXPECT_THAT(on_device.witness, HasSubstr("of the device's memory"));
    EXPECT_EQ(check_of(all, all.cells[all.cells[0].executor == "cuda" ? 1 : 0]).status,
              results::Status::exact);
}

TEST(BenchOnDevice, QueryPairsThere) {
    const std::string file = fmt::format("{}/boxwood_device_{}.csv", testing::TempDir(), getpid());
    std::ofstream(file) << "0,0,0,2,2,2\n1,1,1,3,3,3\n5,5,5,6,6,6\n2,2,2,5,5,5\n";
    std::ostringstream said;
    PairsQuery query;
    query.boxes = file;
    query.device = "cuda:0";
    run(query, said);
    EXPECT_EQ(said.str(), "0,1\n0,3\n1,3\n2,3\n");
    std::remove(file.c_str());
}

} // namespace
} // namespace boxwood::bench
