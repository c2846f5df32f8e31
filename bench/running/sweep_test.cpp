/// Whole sweeps, run by the `boxwood` program that stands one folder above this test's.

#include "bench/running/sweep.h"

#include "bench/io/bad_input.h"
#include "bench/running/instructions/count.h"
#include "bench/running/shards.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <thread>

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

fs::path program() {
    return fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "boxwood";
}

std::string text_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

template <class Condition> bool wait_until(Condition condition) {
    for (int i = 0; i < 6000; ++i) {
        if (condition())
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

/// CPU time of a process in seconds; negative if it is gone or a zombie.
double cpu_s(pid_t pid) {
    std::istringstream stat(text_of("/proc/" + std::to_string(pid) + "/stat"));
    std::string field;
    double user = 0, system = 0;
    for (int i = 1; i <= 15 && stat >> field; ++i) {
        if (i == 3 && field == "Z")
            return -1;
        if (i == 14)
            user = std::stod(field);
        if (i == 15)
            system = std::stod(field);
    }
    return stat ? (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK)) : -1;
}

pid_t child_of(pid_t pid) {
    const std::string id = std::to_string(pid);
    std::istringstream children(text_of("/proc/" + id + "/task/" + id + "/children"));
    pid_t child = 0;
    children >> child;
    return child;
}

struct SweepTest : testing::Test {
    fs::path folder;
    fs::path config() const { return folder / "sweep.toml"; }
    fs::path out() const { return folder / "out.h5"; }
    fs::path log() const { return folder / "log.txt"; }

    void SetUp() override {
        if (!fs::exists(program()))
            GTEST_SKIP() << program() << " is not built";
        std::string name = fs::temp_directory_path() / "boxwood-sweep-XXXXXX";
        ASSERT_TRUE(mkdtemp(name.data()));
        folder = name;
        write_config("n = 300\nbuilders = [\"median\", \"binned_sah\"]\npeers = \"brute_force\"\n",
                     20);
    }
    void TearDown() override {
        if (!folder.empty())
            fs::remove_all(folder);
    }

    void write_config(const std::string& block, int min_time_ms) const {
        std::ofstream(config()) << "rounds = 3\nmin_time_ms = " << min_time_ms
                                << "\n[[cells]]\nscene = \"uniform\"\ntask = \"pairs\"\n"
                                << block;
    }

    pid_t start(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"boxwood", "sweep", "--config", config(), "--out", out()};
        words.insert(words.end(), more.begin(), more.end());
        std::vector<char*> pointers;
        for (std::string& word : words)
            pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const pid_t pid = fork();
        if (pid == 0) {
            const int file = open(log().c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
            dup2(file, 1);
            dup2(file, 2);
            execv(program().c_str(), pointers.data());
            _exit(127);
        }
        return pid;
    }

    static int wait_for(pid_t pid) {
        int status = 0;
        waitpid(pid, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }
    int sweep(const std::vector<std::string>& more = {}) const { return wait_for(start(more)); }

    /// The shard files there are, by round.
    std::map<unsigned, fs::path> shard_files() const {
        std::map<unsigned, fs::path> files;
        std::error_code error;
        for (const auto& entry :
             fs::recursive_directory_iterator(out().string() + ".shards", error)) {
            unsigned round = 0;
            char end = 0;
            const std::string name = entry.path().filename();
            if (std::sscanf(name.c_str(), "round-%u.h%c", &round, &end) == 2 &&
                name.ends_with(".h5"))
                files[round] = entry.path();
        }
        return files;
    }

    /// Which process measured which round.
    static std::map<unsigned, unsigned> pids(const results::Results& results) {
        std::map<unsigned, unsigned> by_round;
        for (const results::Shard& shard : results.shards)
            EXPECT_TRUE(by_round.emplace(shard.round, shard.pid).second) << "a round twice";
        return by_round;
    }
    std::map<unsigned, unsigned> pids_of_shards() const {
        std::map<unsigned, unsigned> by_round;
        for (const auto& [round, file] : shard_files())
            by_round[round] = pids(results::read(file)).at(round);
        return by_round;
    }
};

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
    EXPECT_FALSE(fs::exists(folder / "out.log"));

    fs::remove(base);
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

TEST_F(SweepTest, ABudgetAddsRoundsAndTakesThemAway) {
    write_config("n = 100\nbuilders = \"median\"\npeers = \"brute_force\"\n", 1);
    ASSERT_EQ(sweep({"--budget", "2s"}), 0) << text_of(log());
    EXPECT_GT(pids(results::read(out())).size(), 3u); // three leave comparisons open
    EXPECT_THAT(text_of(log()),
                testing::AnyOf(HasSubstr("has its verdict"), HasSubstr("the budget is spent; ")));
    fs::remove(out());
    ASSERT_EQ(sweep({"--rounds", "12", "--budget", "0.001s"}), 0) << text_of(log());
    EXPECT_EQ(pids(results::read(out())).size(), 9u);
    for (const char* bad : {"10", "-1s", "0min", "1day"})
        EXPECT_EQ(sweep({"--budget", bad}), 2) << bad;
}

TEST_F(SweepTest, PaddingIsDrawnByRound) {
    ASSERT_EQ(sweep(), 0) << text_of(log());
    std::set<std::uint64_t> paddings;
    for (const results::Shard& shard : results::read(out()).shards)
        paddings.insert(shard.padding_bytes);
    EXPECT_EQ(paddings.size(), 3u);
    EXPECT_LT(*paddings.rbegin(), 4096u);
}

TEST_F(SweepTest, ColdBuildsAreThoseOfFreshProcesses) {
    using results::Phase;
    write_config("n = 3000\nbuilders = \"median\"\npeers = \"brute_force\"\ncold_build = true\n",
                 2);
    ASSERT_EQ(sweep(), 0) << text_of(log());
    const results::Results got = results::read(out());
    std::map<Phase, std::vector<double>> ns;
    for (const results::Sample& sample : got.samples)
        if (sample.cell_id == 0) {
            ns[sample.phase].push_back(sample.wall_ns);
            EXPECT_EQ(sample.flags & results::wrong_answer, 0u);
        }
    ASSERT_GE(ns[Phase::cold_build].size(), 2u);
    ASSERT_EQ(ns[Phase::cold_build].size(), ns[Phase::cold_build_and_query].size());
    EXPECT_GT(std::ranges::min(ns[Phase::cold_build_and_query]),
              std::ranges::max(ns[Phase::build])); // pages are touched, and it answers
    EXPECT_TRUE(std::ranges::any_of(got.compare, [](const results::Comparison& row) {
        return row.phase == Phase::cold_build_and_query && row.family == results::Family::peers;
    }));
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

TEST_F(SweepTest, CountsTheSameInstructionsTwice) {
    try {
        under_callgrind(folder / "dumps");
    } catch (const BadInput& missing) {
        GTEST_SKIP() << missing.what();
    }
    write_config("n = 300\nbuilders = \"median\"\npeers = \"brute_force\"\n", 1);
    std::map<std::string, std::uint64_t> earlier;
    for (int run = 0; run < 2; ++run) {
        fs::remove(out());
        ASSERT_EQ(sweep({"--count"}), 0) << text_of(log());
        const results::Results r = results::read(out());
        EXPECT_TRUE(r.samples.empty());
        EXPECT_THAT(r.texts.at("instructions_by"), HasSubstr("valgrind"));
        std::map<std::string, std::uint64_t> counts;
        for (const results::Counter& row : r.counters)
            if (row.counter.starts_with("instructions_"))
                counts[r.cells.at(row.cell_id).name + " " + row.counter] = row.value;
        ASSERT_EQ(counts.size(), 2u); // build and query of ours
        for (const auto& [name, count] : counts) {
            EXPECT_GT(count, 10'000u) << name; // at least one per item and level
            if (run > 0) {
                const auto before = static_cast<double>(earlier[name]);
                EXPECT_NEAR(static_cast<double>(count), before, 1e-3 * before) << name;
            }
        }
        earlier = counts;
    }
    EXPECT_EQ(sweep({"--count"}), 2); // OUT is there
    EXPECT_FALSE(fs::exists(out().string() + ".shards"));
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
