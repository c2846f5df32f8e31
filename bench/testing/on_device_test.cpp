/// What the bench does with contenders on a device, on the host's model of one.

#include "bench/commands/queries/query.h"
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

/// Every cell of a device that has a form is right, or wrong as on the CPU, and answers as the same
/// contender there.
void expect_right(const std::string& scene, const std::string& block, std::size_t n_forms) {
    SCOPED_TRACE(block);
    const Plan plan = plan_of(
        "[[cells]]\nn = 120\nscene = \"" + scene +
        "\"\nexecutors = [\"serial\", \"cuda\", \"cuda_resident\", \"cuda_graph\"]\n" + block);
    const results::Results all = prepared(plan);
    std::map<std::pair<std::uint32_t, std::uint32_t>, results::Check> of_cpu; // scene, variant
    for (const results::Cell& cell : all.cells)
        if (cell.executor == "serial")
            of_cpu[{cell.scene_id, cell.variant_id}] = check_of(all, cell);
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
        const results::Check& wanted = of_cpu[{cell.scene_id, cell.variant_id}];
        EXPECT_EQ(check.status, wanted.status) << cell.name << ": " << check.witness;
        EXPECT_EQ(check.result_hash, wanted.result_hash) << cell.name;
        EXPECT_TRUE(check.status != results::Status::wrong || cell.task == "triangle_pairs");
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
                 12);
    expect_right("uniform", "task = \"nearest\"\nn_points = 30\nk = 3\n" + trees, 4);
}

TEST(BenchOnDevice, RaysAnswerThereAsOnTheCpu) {
    const std::string rays =
        "rays = \"random\"\nn_rays = 50\nbuilders = [\"hilbert\", \"ploc\"]\n"
        "layouts = [\"packed\", \"wide8\"]\nray_order = [\"given\", \"sorted\", \"single\"]\n"
        "kernels = [\"watertight\", \"moller_trumbore_f32\", \"plucker_f32\"]\n";
    expect_right("sphere_mesh", "task = \"rays_closest\"\n" + rays, 16);
    expect_right("sphere_mesh", "task = \"rays_any\"\n" + rays, 16);
    expect_right("sphere_mesh",
                 "task = \"rays_all\"\nrays = \"random\"\nn_rays = 50\n"
                 "builders = [\"hilbert\", \"lbvh\", \"ploc\"]\n"
                 "layouts = [\"packed\", \"wide8\"]\n"
                 "kernels = [\"watertight\", \"plucker_f32\"]\n",
                 4);
}

TEST(BenchOnDevice, TouchingTrianglesAreThoseOfTheCpu) {
    expect_right("sphere_mesh",
                 "task = \"triangle_pairs\"\nbuilders = [\"hilbert\", \"lbvh\", \"ploc\"]\n"
                 "layouts = [\"packed\", \"binary\"]\n"
                 "kernels = [\"guigue_devillers_f32_batch\", \"guigue_devillers_f64\", "
                 "\"guigue_devillers_exact_f32_batch\", \"moller_f32\"]\n",
                 18);
}

/// Answers are judged by the truth of the CPU's, on every family.
TEST(BenchOnDevice, KernelsOfTwoTrianglesKeepTheirPromise) {
    for (const auto& [task, n_kernels] :
         {std::pair<std::string, int>{"triangle_triangle", 3}, {"triangle_distance", 2}}) {
        SCOPED_TRACE(task);
        const Plan plan = plan_of("[[cells]]\nn = 40\nscene = \"all\"\ntask = \"" + task +
                                  "\"\nexecutors = [\"serial\", \"cuda\", \"cuda_resident\"]\n");
        const results::Results all = prepared(plan);
        std::map<std::uint32_t, int> on_device; // by scene
        for (const results::Cell& cell : all.cells) {
            const results::Check& check = check_of(all, cell);
            if (!is_device(cell.executor) || check.status == results::Status::unsupported)
                continue;
            ++on_device[cell.scene_id];
            const auto serial = std::ranges::find_if(all.cells, [&](const results::Cell& other) {
                return other.scene_id == cell.scene_id && other.variant_id == cell.variant_id &&
                       other.executor == "serial";
            });
            EXPECT_EQ(check.status, check_of(all, *serial).status)
                << cell.name << ": " << check.witness;
            EXPECT_EQ(check.extra + check.missing,
                      check_of(all, *serial).extra + check_of(all, *serial).missing);
        }
        EXPECT_GT(on_device.size(), 10u);
        for (const auto& [scene, n] : on_device)
            EXPECT_EQ(n, 2 * n_kernels);
        for (const results::KernelRow& row : all.kernels)
            EXPECT_EQ(is_device(all.cells.at(row.cell_id).executor),
                      row.kernel.ends_with(" on a device") || row.kernel.ends_with(" resident"));
    }
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
