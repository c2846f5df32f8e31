#include "bench/running/sweep.h"

#include "bench/io/bad_input.h"
#include "bench/running/shards.h"
#include "bench/running/sweep_fixture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <set>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

TEST_F(SweepTest, TellsNothingOfTreesThatWereNotMade) {
    std::ofstream(config()) << "rounds = 1\nmin_time_ms = 1\n[[cells]]\nscene = \"sphere_mesh\"\n"
                               "n = 300\ntask = \"triangle_pairs\"\nbuilders = "
                               "\"hilbert\"\nlayouts = [\"packed\", \"wide8_f64\"]\nkernels = "
                               "\"guigue_devillers_exact\"\n";
    ASSERT_EQ(sweep(), 0) << text_of(log());
    const results::Results r = results::read(out());
    ASSERT_EQ(r.cells.size(), 2u);
    std::set<std::uint32_t> with_tree, of_doubles;
    for (const results::TreeRow& tree : r.trees)
        with_tree.insert(tree.cell_id);
    for (const results::Cell& cell : r.cells)
        if (cell.precision == "f64")
            of_doubles.insert(cell.cell_id);
    EXPECT_EQ(with_tree.size(), 1u);
    EXPECT_EQ(with_tree, of_doubles); // packed took the order alone
}

TEST_F(SweepTest, ThatCouldTimeNothingFails) {
    write_config("n = 100\nbuilders = \"median\"\nexecutors = \"cuda_graph\"\nthreads = 2\n", 1);
    EXPECT_EQ(sweep(), 1); // a device counts as one thread
    EXPECT_THAT(text_of(log()), HasSubstr("nothing was timed"));
    EXPECT_THAT(text_of(log()), HasSubstr("a cell of a device left out: "));
    EXPECT_EQ(results::read(out()).checks.at(0).status, results::Status::unsupported);
}

TEST_F(SweepTest, AgainstAnotherProgramTakesTurns) {
    const fs::path base = folder / "out.base.h5";
    const std::vector<std::string> against{"--against", program()};
    std::ofstream(folder / "out.log") << "the user's own";
    const pid_t pid = start(against);
    ASSERT_TRUE(wait_until([&] { return fs::exists(base); })) << text_of(log());
    kill(pid, SIGINT);
    EXPECT_EQ(wait_for(pid), 130) << text_of(log());
    EXPECT_EQ(sweep(against), 3) << text_of(log()); // three rounds cannot tell
    EXPECT_THAT(text_of(log()), HasSubstr("head     " + out().string()));
    std::map<std::uint64_t, char> by_time;
    for (const auto& [file, who] : {std::pair{base, 'b'}, {out(), 'h'}})
        for (const results::Shard& shard : results::read(file).shards)
            by_time[shard.t0_utc_ns] = who;
    std::string order;
    for (const auto& [time, who] : by_time)
        order += who;
    ASSERT_EQ(order.size(), 6u);
    for (std::size_t round = 0; round < 3; ++round) // of both before the next
        EXPECT_NE(order[2 * round], order[2 * round + 1]) << order;
    EXPECT_EQ(std::ranges::count(order, 'b'), 3);
    EXPECT_EQ(text_of(folder / "out.log"), "the user's own");
    EXPECT_FALSE(fs::exists(out().string() + ".turns.log"));
    EXPECT_FALSE(fs::exists(base.string() + ".turns.log"));

    fs::remove(base);
    const fs::path other = folder / "other", heard = folder / "heard";
    std::ofstream(other) << "#!/bin/sh\necho \"$*\" >" << heard.string() << "\nexit 2\n";
    fs::permissions(other, fs::perms::owner_all);
    EXPECT_EQ(sweep({"--against", other, "--threads", "1"}), 2);
    EXPECT_THAT(text_of(heard), testing::EndsWith("--rounds 1 --threads 1\n"));
    EXPECT_EQ(sweep({"--against", other, "--wait", "0s", "--give-up", "2min"}), 2);
    EXPECT_THAT(text_of(heard), testing::EndsWith("--rounds 1 --wait 0s --give-up 120s\n"));

    EXPECT_EQ(sweep({"--against", "/bin/false"}), 2);
    EXPECT_THAT(text_of(log()), HasSubstr("/bin/false"));
    EXPECT_EQ(sweep({"--against", folder}), 2);
    EXPECT_THAT(text_of(log()), HasSubstr("is no program"));
}

TEST_F(SweepTest, MeasuresChecksAndCleansUp) {
    ASSERT_EQ(sweep(), 0) << text_of(log());
    const results::Results r = results::read(out());
    EXPECT_EQ(rounds_in(r), (std::set<unsigned>{0, 1, 2}));
    EXPECT_EQ(r.cells.size(), 3u);
    EXPECT_EQ(r.samples.size(), 3u * 2 * (3 + 1)); // rounds, phases, cells and the A/A twin
    EXPECT_EQ(r.checks.size(), 3u);
    for (const results::Check& check : r.checks)
        EXPECT_EQ(check.status, results::Status::exact);
    EXPECT_EQ(r.trees.size(), 2u);
    EXPECT_EQ(r.env.size(), 1u);
    EXPECT_FALSE(r.compare.empty());
    EXPECT_EQ(r.health.size(), 1u);
    EXPECT_FALSE(r.medians.empty());
    EXPECT_FALSE(r.packages.empty());
    EXPECT_FALSE(fs::exists(out().string() + ".shards"));
    EXPECT_THAT(text_of(log()), HasSubstr("brute force"));
    EXPECT_THAT(text_of(log()), testing::Not(HasSubstr("DEBUG")));
}

TEST_F(SweepTest, KernelsAreTimedWhereTheyErrAndJudgedByTheirPromise) {
    std::ofstream(config()) << "rounds = 2\nmin_time_ms = 1\n[[cells]]\nscene = "
                               "\"edge_on_edge\"\ntask = [\"triangle_triangle\", "
                               "\"point_segment\"]\nn = 200\npeers = \"all\"\n";
    ASSERT_EQ(sweep(), 0) << text_of(log());
    const results::Results r = results::read(out());
    EXPECT_EQ(r.kernels.size(), r.cells.size());
    EXPECT_FALSE(r.conditions.empty());
    std::set<std::uint32_t> wrong, timed;
    for (const results::KernelRow& row : r.kernels)
        if (row.status == results::Status::wrong)
            wrong.insert(row.cell_id);
    for (const results::Sample& sample : r.samples) {
        EXPECT_EQ(sample.phase, results::Phase::query);
        timed.insert(sample.cell_id);
    }
    EXPECT_FALSE(wrong.empty()); // plain doubles do not get these right
    EXPECT_TRUE(std::ranges::includes(timed, wrong));
    EXPECT_THAT(text_of(log()), HasSubstr("kernels on hard cases"));
    EXPECT_FALSE(r.kernel_costs.empty());
    EXPECT_EQ(r.health.at(0).broken_promises, 0u);
}

TEST_F(SweepTest, MoreRoundsExtendAndShardsShareThem) {
    ASSERT_EQ(sweep({"--shard", "1/2"}), 0) << text_of(log());
    const auto first = pids(results::read(out()));
    EXPECT_EQ(first.size(), 1u);
    ASSERT_EQ(sweep({"--rounds", "4"}), 0) << text_of(log());
    const auto all = pids(results::read(out()));
    EXPECT_EQ(all.size(), 4u);
    EXPECT_EQ(all.at(1), first.at(1));
    ASSERT_EQ(sweep(), 0); // nothing to do
    EXPECT_EQ(pids(results::read(out())), all);
}

TEST_F(SweepTest, TwoDoNotWriteOneFile) {
    const pid_t first = start();
    const fs::path lock = out().string() + ".shards/lock";
    ASSERT_TRUE(wait_until([&] { return text_of(lock) == std::to_string(first); }));
    EXPECT_EQ(sweep({"--rounds", "4"}), 2);
    EXPECT_THAT(text_of(log()), HasSubstr("another sweep writes " + out().string()));
    EXPECT_THAT(text_of(log()), HasSubstr("(process " + std::to_string(first) + ")"));
    EXPECT_EQ(wait_for(first), 0);
    EXPECT_EQ(pids(results::read(out())).size(), 3u);
    EXPECT_FALSE(fs::exists(lock.parent_path()));
}

TEST_F(SweepTest, KillingItAtAnyMomentLosesAtMostOneRound) {
    std::map<unsigned, unsigned> kept;
    for (const int ms : {20, 90, 250, 400, 700}) {
        const pid_t parent = start();
        std::this_thread::sleep_for(std::chrono::milliseconds(ms));
        const pid_t child = child_of(parent);
        kill(parent, SIGKILL);
        wait_for(parent);
        EXPECT_TRUE(child == 0 || wait_until([&] { return cpu_s(child) < 0; })) << "orphan";
        if (fs::exists(out())) // it was done already
            break;
        const auto now = pids_of_shards();
        EXPECT_TRUE(std::ranges::includes(now, kept)) << "a finished round was lost";
        kept = now;
    }
    ASSERT_EQ(sweep(), 0) << text_of(log());
    const auto all = pids(results::read(out()));
    EXPECT_EQ(all.size(), 3u);
    EXPECT_TRUE(std::ranges::includes(all, kept));
}

TEST_F(SweepTest, CtrlCKeepsFinishedRounds) {
    for (const int signal : {SIGINT, SIGTERM}) {
        const pid_t parent = start({"--rounds", "60"});
        const std::size_t before = shard_files().size();
        ASSERT_TRUE(wait_until([&] { return shard_files().size() > before; }));
        kill(parent, signal);
        EXPECT_EQ(wait_for(parent), 130);
        EXPECT_THAT(text_of(log()), HasSubstr("interrupted"));
        EXPECT_GE(rounds_in(results::read(out())).size(), before + 1);
    }
    const auto kept = pids(results::read(out()));
    ASSERT_EQ(sweep({"--rounds", std::to_string(kept.size() + 1)}), 0) << text_of(log());
    EXPECT_TRUE(std::ranges::includes(pids(results::read(out())), kept));
}

/// Waits for a round that has worked for a while, so that it is in a cell, and ends it.
bool shoot_child(pid_t parent, pid_t& last) {
    return wait_until([&] {
        const pid_t child = child_of(parent);
        const std::string line = text_of("/proc/" + std::to_string(child) + "/cmdline");
        if (child <= 0 || child == last || line.find("--prepared") == std::string::npos ||
            cpu_s(child) < 0.3)
            return false;
        last = child;
        return kill(child, SIGKILL) == 0;
    });
}

TEST_F(SweepTest, ACellThatCrashesTwiceIsLeftOut) {
    write_config("n = 20000\npeers = \"brute_force\"\n", 1000);
    pid_t last = 0;
    const pid_t parent = start();
    ASSERT_TRUE(shoot_child(parent, last));
    ASSERT_TRUE(shoot_child(parent, last));
    EXPECT_EQ(wait_for(parent), 1) << text_of(log());
    const results::Results r = results::read(out());
    ASSERT_EQ(r.checks.size(), 1u);
    EXPECT_EQ(r.checks[0].status, results::Status::wrong);
    EXPECT_THAT(r.checks[0].witness, HasSubstr("crashed: signal 9"));
    EXPECT_EQ(rounds_in(r).size(), 3u);
    EXPECT_TRUE(r.samples.empty());
}

TEST_F(SweepTest, RefusesToOverwriteOtherFiles) {
    const std::string text = "precious";
    std::ofstream(out()) << text;
    EXPECT_EQ(sweep(), 2);
    EXPECT_THAT(text_of(log()), HasSubstr("choose another --out"));
    EXPECT_EQ(text_of(out()), text);
    fs::remove(out());
    ASSERT_EQ(sweep({"--rounds", "1"}), 0);
    const std::string bytes = text_of(out());
    EXPECT_EQ(sweep({"--seed", "2"}), 2);
    EXPECT_THAT(text_of(log()), HasSubstr("another sweep"));
    EXPECT_EQ(text_of(out()), bytes);
}

TEST_F(SweepTest, TellsBeforeMeasuringThatThePlaceTakesNoData) {
    SweepOptions options;
    options.config = config();
    options.out = folder / "missing" / "out.h5";
    EXPECT_THROW(run_sweep(options), BadInput);
    options.out = config() / "out.h5";
    EXPECT_THROW(run_sweep(options), BadInput);

    // A file size limit stands for a full disk: writing fails in the same place.
    options.out = out();
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{1000, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    std::string message;
    try {
        run_sweep(options);
    } catch (const BadInput& error) {
        message = error.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_THAT(message, HasSubstr("cannot write in"));
    EXPECT_FALSE(fs::exists(out().string() + ".shards"));
}

} // namespace
} // namespace boxwood::bench
