/// Answers of any size, and whatever floating-point mode the program is started in.

#include "bench/commands/program.h"
#include "bench/commands/queries/query.h"
#include "bench/commands/queries/watched_pairs.h"
#include "bench/io/bad_input.h"
#include "bench/running/interrupt.h"
#include "kernels/arithmetic/float_mode.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace boxwood::bench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class HugePairs : public ::testing::Test {
  protected:
    ~HugePairs() override { std::filesystem::remove(file_); }

    /// n boxes that all meet.
    PairsQuery identical(std::size_t n) const {
        std::string text;
        for (std::size_t i = 0; i < n; ++i)
            text += "0,0,0,1,1,1\n";
        return rows(text);
    }
    PairsQuery rows(const std::string& text) const {
        std::ofstream(file_) << text;
        PairsQuery query;
        query.boxes = file_.string();
        return query;
    }
    static std::string answer(const PairsQuery& query) {
        std::ostringstream out;
        run(query, out);
        return out.str();
    }
    /// What a function writes to stderr.
    template <class F> static std::string said(const F& f) {
        ::testing::internal::CaptureStderr();
        f();
        return ::testing::internal::GetCapturedStderr();
    }

    std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                  ("boxwood_pairs_" + std::to_string(std::random_device{}()));
};

TEST_F(HugePairs, TheLimitEndsTheListAndSaysSo) {
    PairsQuery query = identical(9000); // 4e7 pairs, in many chunks
    query.limit = 1000;
    std::string some;
    EXPECT_THAT(said([&] { some = answer(query); }), HasSubstr("stopped at 1000 pairs"));
    EXPECT_EQ(std::count(some.begin(), some.end(), '\n'), 1000);
    for (const char* executor : {"serial", "tbb", "openmp"}) { // the same on any threads
        query.tree.executor = executor;
        query.tree.threads = executor == std::string("serial") ? 1 : 3;
        EXPECT_EQ(answer(query), some) << executor;
    }
    std::istringstream lines(some); // each once, in order, and a pair
    std::pair<unsigned, unsigned> last{0, 0};
    for (std::string line; std::getline(lines, line);) {
        std::pair<unsigned, unsigned> pair;
        ASSERT_EQ(std::sscanf(line.c_str(), "%u,%u", &pair.first, &pair.second), 2) << line;
        EXPECT_LT(pair.first, pair.second);
        EXPECT_LT(last, pair);
        last = pair;
    }
}

TEST_F(HugePairs, AListWithinTheLimitIsComplete) {
    PairsQuery query = identical(4); // 6 pairs
    const std::string all = answer(query);
    for (const std::uint64_t limit : {std::uint64_t{6}, std::uint64_t{7}, ~std::uint64_t{0}}) {
        query.limit = limit;
        std::string text;
        EXPECT_EQ(said([&] { text = answer(query); }), "") << limit;
        EXPECT_EQ(text, all) << limit;
    }
    query.format.json = true;
    EXPECT_THAT(answer(query), HasSubstr("\"count\":6,\"complete\":true,\"pairs\":[[0,1]"));
    query.limit = 5;
    EXPECT_THAT(answer(query), HasSubstr("\"count\":5,\"complete\":false,\"pairs\":[["));
}

TEST_F(HugePairs, WhatDoesNotFitIsRefusedBeforeAnythingIsPrinted) {
    PairsQuery query = identical(3000);
    query.max_bytes = 16'000; // 1000 pairs
    for (const char* layout : {"wide8", "wide8_f64", "packed"}) {
        query.tree.layout = layout;
        std::ostringstream out;
        try {
            run(query, out);
            ADD_FAILURE() << layout;
        } catch (const BadInput& error) {
            EXPECT_THAT(error.what(), AllOf(HasSubstr("more than 1000 pairs overlap"),
                                            HasSubstr("--count"), HasSubstr("--limit")));
        }
        EXPECT_EQ(out.str(), "");
    }
    query.limit = 1001; // a limit that does not fit either
    EXPECT_THROW(answer(query), BadInput);
    query.limit = 1000;
    const std::string some = answer(query);
    EXPECT_EQ(std::count(some.begin(), some.end(), '\n'), 1000);
    query.limit.reset();
    query.count = true;
    EXPECT_EQ(answer(query), "4498500\n");
}

TEST_F(HugePairs, ProgressIsSaidAndCtrlCStops) {
    std::FILE* log = std::tmpfile();
    Progress progress(log);
    std::uint64_t taken = 0;
    ForEachPair sink([&](Pair) {
        ++taken;
        return true;
    });
    const auto found = [&] { return std::to_string(taken) + " pairs"; };
    WatchedPairs watched(sink, progress, "counting", found, std::chrono::seconds(0));
    const std::vector<Pair> pairs(10, Pair{0, 1});
    {
        const CtrlC ctrl_c;
        watched.begin(4, true);
        EXPECT_TRUE(watched.take(0, pairs));
        watched.finish(0);
        std::raise(SIGINT);
        EXPECT_TRUE(CtrlC::pressed());
        EXPECT_FALSE(watched.take(1, pairs));
        EXPECT_EQ(watched.fraction(), 0.25);
        EXPECT_EQ(taken, 10u);
    }
    const CtrlC again;
    EXPECT_FALSE(CtrlC::pressed());
    std::rewind(log);
    std::string text(1000, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), log));
    std::fclose(log);
    EXPECT_THAT(text, HasSubstr("counting: 25 %, 10 pairs, "));
    EXPECT_THAT(text, HasSubstr(" left\n"));
}

TEST_F(HugePairs, ANegativeLimitIsRefused) {
    const PairsQuery boxes = rows("0,0,0,1,1,1\n0,0,0,1,1,1\n");
    for (const char* limit : {"-1", "0", "x"}) {
        std::vector<std::string> words{"boxwood", "query", "pairs", boxes.boxes,
                                       fmt::format("--limit={}", limit)};
        std::vector<char*> pointers;
        for (std::string& word : words)
            pointers.push_back(word.data());
        EXPECT_EQ(run_program(static_cast<int>(words.size()), pointers.data()), 2) << limit;
    }
}

TEST_F(HugePairs, ProgressIsByWork) {
    std::FILE* log = std::tmpfile();
    Progress progress(log);
    CountPairs count;
    WatchedPairs watched(count, progress, "counting", [] { return std::string(); });
    // As of identical boxes: 90 light chunks, then 10 with 100 times their work.
    watched.begin(100, true);
    const std::vector<Pair> light(10'000, Pair{0, 1}), heavy(1'000'000, Pair{0, 1});
    for (std::size_t chunk = 0; chunk < 90; ++chunk) {
        watched.take(chunk, light);
        watched.finish(chunk);
    }
    watched.take(90, heavy);            // and not finished
    EXPECT_LT(watched.fraction(), .35); // of chunks 90 %, of work 17 %
    for (std::size_t chunk = 91; chunk < 100; ++chunk)
        watched.take(chunk, heavy);
    for (std::size_t chunk = 90; chunk < 100; ++chunk)
        watched.finish(chunk);
    EXPECT_EQ(watched.fraction(), 1);
    // Chunks of one size.
    watched.begin(4, true);
    for (std::size_t chunk = 0; chunk < 3; ++chunk) {
        watched.take(chunk, light);
        watched.finish(chunk);
    }
    EXPECT_EQ(watched.fraction(), .75);
    std::fclose(log);
}

/// The program's stdout, started while denormals are flushed in this thread or not.
std::string printed(std::vector<std::string> words, bool flushing) {
    std::vector<char*> pointers;
    for (std::string& word : words)
        pointers.push_back(word.data());
    const DenormalFlushing mode(flushing);
    ::testing::internal::CaptureStdout();
    EXPECT_EQ(run_program(static_cast<int>(words.size()), pointers.data()), 0);
    EXPECT_EQ(flushes_denormals(), flushing);
    return ::testing::internal::GetCapturedStdout();
}

TEST_F(HugePairs, TheProgramKeepsDenormalsInWhateverModeItIsStarted) {
    if (float_mode::flushing == 0)
        GTEST_SKIP() << "no flushing known on this processor";
    // Apart by less than any normal double, and by less than any normal float.
    const PairsQuery boxes = rows("0,0,0,1e-320,1,1\n2e-320,0,0,1,1,1\n1e-320,0,0,3e-320,1,1\n"
                                  "-1,-1,-1,-2e-42,1,1\n-1e-42,0,0,0,1,1\n");
    const std::string expected = "0,2\n0,4\n1,2\n";
    for (const bool flushing : {false, true})
        for (const LayoutEntry& layout : layouts())
            if (layout.answers(Query::self_pairs)) {
                EXPECT_EQ(printed({"boxwood", "query", "pairs", boxes.boxes, "--layout",
                                   std::string(layout.name), "--threads", "3"},
                                  flushing),
                          expected)
                    << layout.name << (flushing ? ", flushing" : "");
            }
    const std::filesystem::path mesh = file_.string() + ".obj";
    std::ofstream(mesh) << "v -1 -1 0\nv 3 -1 0\nv -1 3 0\nf 1 2 3\n";
    const PairsQuery rays = rows("0,0,-1,0,0,1e-40\n");
    for (const bool flushing : {false, true}) // a direction that is no zero
        EXPECT_THAT(
            printed({"boxwood", "query", "rays", mesh.string(), rays.boxes, "--any"}, flushing),
            Not(HasSubstr("error")));
    std::filesystem::remove(mesh);
}

} // namespace
} // namespace boxwood::bench
