#include "bench/commands/compare.h"

#include "bench/analysis/analyse.h"
#include "bench/commands/command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// One cell timed in some rounds, the same in each but for one part in a thousand.
results::Results timed(double ns, std::uint32_t rounds = 9,
                       results::Status status = results::Status::exact) {
    results::Results results;
    results.env.resize(1);
    results.env[0].git_commit = "0123456789abcdef";
    results.scenes.resize(1);
    results.variants.resize(1);
    results.tasks.resize(1);
    results.cells.resize(1);
    results.cells[0].name = "soup/ours";
    results.checks.resize(1);
    results.checks[0].status = status;
    for (std::uint32_t round = 0; round < rounds; ++round) {
        results::Shard shard;
        shard.shard_id = shard.round = round;
        results.shards.push_back(shard);
        results::Sample sample;
        sample.shard_id = sample.round = round;
        sample.phase = results::Phase::query;
        sample.wall_ns = ns * (1 + 0.001 * (round % 3));
        results.samples.push_back(sample);
    }
    analyse(results);
    return results;
}

int exit_of(const results::Results& base, const results::Results& head,
            std::optional<double> fail_if = std::nullopt) {
    return exit_code_of(compare_files(base, head, {.fail_if = fail_if}).gate);
}

std::string text_of(const results::Results& base, const results::Results& head,
                    const FileView& view = {}) {
    return comparison_text(base, head, compare_files(base, head), {}, view);
}

/// Adds cell 1, of a peer with this time in each of the rounds.
results::Results with_peer(results::Results results, double ns) {
    results.variants.push_back(results.variants[0]);
    results.variants[1].variant_id = 1;
    results.variants[1].is_peer = 1;
    results.cells.push_back(results.cells[0]);
    results.cells[1].cell_id = results.cells[1].variant_id = 1;
    results.cells[1].name = "soup/peer";
    for (std::size_t i = results.samples.size(); i-- > 0;) {
        results.samples.push_back(results.samples[i]);
        results.samples.back().cell_id = 1;
        results.samples.back().wall_ns = ns;
    }
    analyse(results);
    return results;
}

TEST(CompareCommand, Percentages) {
    EXPECT_DOUBLE_EQ(percent_of("5%"), 0.05);
    EXPECT_DOUBLE_EQ(percent_of("0.5 %"), 0.005);
    EXPECT_DOUBLE_EQ(fail_threshold("slower>5%"), 0.05);
    EXPECT_DOUBLE_EQ(fail_threshold("slower > 12.5 %"), 0.125);
    for (const char* bad : {"", "5", "%", "five%", "-5%", "5%%", "nan%", "inf%", "1e9%"})
        EXPECT_THROW(percent_of(bad), BadInput) << bad;
    for (const char* bad : {"", "slower", "faster>5%", "slower>", "slower>=5%", "slower>5"})
        EXPECT_THROW(fail_threshold(bad), BadInput) << bad;
}

TEST(CompareCommand, AFileWithItselfIsTheSameHoweverNoisy) {
    for (const std::uint32_t rounds : {1u, 8u, 9u, 20u})
        for (const results::Status status :
             {results::Status::exact, results::Status::wrong, results::Status::unchecked}) {
            const auto file = timed(100, rounds, status);
            const bool is_wrong = status == results::Status::wrong;
            EXPECT_EQ(exit_of(file, file), is_wrong ? exit_cannot_tell : exit_success)
                << rounds << to_string(status);
            EXPECT_EQ(exit_of(file, file, 0.0), exit_of(file, file)) << rounds;
            if (!is_wrong) {
                EXPECT_THAT(text_of(file, file), StartsWith("SAME: both files hold the same"));
            }
        }
}

TEST(CompareCommand, ExitCodesFollowFromTheIntervalsShown) {
    const auto base = timed(100);
    EXPECT_EQ(exit_of(base, timed(110)), exit_failed);
    EXPECT_EQ(exit_of(base, timed(110), 0.05), exit_failed);
    EXPECT_EQ(exit_of(base, timed(110), 0.2), exit_success);
    EXPECT_EQ(exit_of(base, timed(102)), exit_success);
    EXPECT_EQ(exit_of(base, timed(102), 0.01), exit_cannot_tell); // the same within 5 %, not 1 %
    EXPECT_EQ(exit_of(base, timed(80)), exit_success);
    EXPECT_EQ(exit_of(timed(100, 8), timed(150, 8)), exit_cannot_tell);
    EXPECT_THAT(text_of(timed(100, 8), timed(150, 8)),
                HasSubstr("To tell: more rounds on a quiet machine"));
    EXPECT_EQ(exit_of(timed(100, 3), timed(101, 3)), exit_cannot_tell);
    EXPECT_EQ(exit_of(base, timed(100, 9, results::Status::wrong)), exit_failed);
    EXPECT_EQ(exit_of(timed(100, 9, results::Status::wrong), base), exit_cannot_tell); // no timing
    // Slower for sure, 1.06 in the middle, but its interval goes from 1.03 to 1.09.
    auto wide = timed(106);
    for (auto& sample : wide.samples)
        sample.wall_ns += 3 * (static_cast<double>(sample.round % 3) - 1);
    analyse(wide);
    EXPECT_EQ(exit_of(base, wide), exit_failed);
    EXPECT_EQ(exit_of(base, wide, 0.05), exit_cannot_tell);
    EXPECT_EQ(exit_of(base, wide, 0.02), exit_failed);
    EXPECT_EQ(exit_of(base, wide, 0.1), exit_success);
}

TEST(CompareCommand, PeersAreNoGateButSayWhetherTheMachineChanged) {
    const auto base = with_peer(timed(100), 1000);
    EXPECT_EQ(exit_of(base, with_peer(timed(110), 1000)), exit_failed);
    EXPECT_EQ(exit_of(base, with_peer(timed(100), 1030)), exit_success);
    for (const double peer_ns : {1110., 900.}) {
        const auto head = with_peer(timed(110), peer_ns);
        EXPECT_EQ(exit_of(base, head), exit_cannot_tell) << peer_ns;
        EXPECT_EQ(exit_of(base, head, 0.12), exit_success) << peer_ns;
        EXPECT_THAT(text_of(base, head),
                    StartsWith("CAN'T TELL: the machine changed and not our code alone, as the "
                               "peers take "));
    }
    const auto wrong = with_peer(timed(100, 9, results::Status::wrong), 2000);
    EXPECT_EQ(exit_of(base, wrong), exit_failed); // an answer is no matter of time
    EXPECT_THAT(text_of(base, base), Not(HasSubstr("soup/peer")));
    EXPECT_THAT(text_of(base, base, {.all = true}), HasSubstr("soup/peer"));
}

TEST(CompareCommand, OnAnotherProcessorTimesSayNothing) {
    auto head = timed(150);
    head.env[0].cpu = "another";
    EXPECT_EQ(exit_of(timed(100), head), exit_cannot_tell);
    const std::string text = text_of(timed(100), head);
    EXPECT_THAT(text, StartsWith("CAN'T TELL: the processors differ, and so do times for that "
                                 "alone (--any-processor compares all the same); "));
    EXPECT_THAT(text, Not(HasSubstr("head is"))); // no table
    auto of_one_name = timed(150);                // a processor with other instruction sets
    of_one_name.env[0].isa_max = "another";
    EXPECT_EQ(exit_of(timed(100), of_one_name), exit_cannot_tell);
    auto renamed = timed(100); // a file that somebody changed
    renamed.env[0].cpu = "another";
    EXPECT_EQ(exit_of(timed(100), renamed), exit_cannot_tell);
    FileOptions forced;
    forced.any_processor = true;
    EXPECT_EQ(compare_files(timed(100), head, forced).gate, Gate::fails);
    EXPECT_THAT(comparison_text(timed(100), head, compare_files(timed(100), head, forced), forced),
                StartsWith("REGRESSION: 1 of 1 timings slower"));
    head.checks[0].status = results::Status::wrong;
    analyse(head);
    EXPECT_EQ(exit_of(timed(100), head), exit_failed);
}

TEST(CompareCommand, WhatTheHeadLacksIsListedAndCannotBeTold) {
    auto base = timed(100);
    base.cells.push_back(base.cells[0]);
    base.cells[1].cell_id = 1;
    base.cells[1].name = "soup/gone";
    base.samples.push_back(base.samples[0]);
    base.samples.back().cell_id = 1;
    analyse(base);
    EXPECT_EQ(exit_of(base, timed(100)), exit_cannot_tell);
    EXPECT_THAT(text_of(base, timed(100)),
                StartsWith("CAN'T TELL: 1 of the base's timings or answers have no counterpart; "));
    EXPECT_THAT(text_of(base, timed(100)), HasSubstr("\nlost: soup/gone: not timed in the head\n"));
    EXPECT_EQ(exit_of(timed(100), base), exit_success);

    auto other = timed(100);
    other.scenes[0].content_hash = 1;
    EXPECT_EQ(exit_of(timed(100), other), exit_cannot_tell);

    const auto unchecked = timed(100, 9, results::Status::unchecked);
    EXPECT_EQ(exit_of(timed(100), unchecked), exit_cannot_tell);
    EXPECT_THAT(text_of(timed(100), unchecked),
                HasSubstr("its answer was not checked in the head"));
    EXPECT_EQ(exit_of(unchecked, unchecked), exit_success);

    auto with_build = timed(100);
    for (std::size_t i = with_build.samples.size(); i-- > 0;) {
        with_build.samples.push_back(with_build.samples[i]);
        with_build.samples.back().phase = results::Phase::build;
    }
    analyse(with_build);
    EXPECT_EQ(exit_of(with_build, timed(100)), exit_cannot_tell);
    EXPECT_THAT(text_of(with_build, timed(100)), HasSubstr("lost: soup/ours: build not timed in"));

    const auto none = [](const std::string& cell) { return cell != "soup/ours"; };
    EXPECT_EQ(compare_files(timed(100), timed(100), {.wanted = none}).gate, Gate::open);
}

TEST(CompareCommand, NothingPassesUnderTheNoise) {
    const auto noisy = [](double ns) {
        auto results = timed(ns);
        for (std::size_t i = results.samples.size(); i-- > 0;) {
            results.samples.push_back(results.samples[i]);
            results.samples.back().flags = results::aa_twin;
            results.samples.back().wall_ns *= 1.1;
        }
        analyse(results);
        return results;
    };
    EXPECT_EQ(exit_of(noisy(100), noisy(101)), exit_cannot_tell);
    EXPECT_THAT(text_of(noisy(100), noisy(101)),
                StartsWith("CAN'T TELL: the noise floor of 10.0 % is above 5 %, and so 1 of 1 "));
    EXPECT_EQ(exit_of(noisy(100), noisy(101), 0.15), exit_success);
    EXPECT_EQ(exit_of(noisy(100), noisy(108)), exit_cannot_tell); // slower, but by less than that
    EXPECT_EQ(exit_of(noisy(100), noisy(120)), exit_failed);
    EXPECT_EQ(exit_of(noisy(100), noisy(50)), exit_success);
}

TEST(CompareCommand, OneCellOfManyJobsIsCaughtInNineRounds) {
    auto base = timed(100);
    for (std::uint32_t id = 1; id < 60; ++id) {
        base.scenes.push_back(base.scenes[0]);
        base.scenes.back().scene_id = id;
        base.cells.push_back(base.cells[0]);
        base.cells.back().cell_id = base.cells.back().scene_id = id;
        base.cells.back().name = "soup" + std::to_string(id);
        for (std::size_t i = 0; i < 9; ++i) {
            base.samples.push_back(base.samples[i]);
            base.samples.back().cell_id = id;
        }
    }
    base.checks.clear();
    for (std::uint32_t id = 0; id < 60; ++id) {
        results::Check check;
        check.cell_id = id;
        check.status = results::Status::exact;
        base.checks.push_back(check);
    }
    auto head = base;
    for (auto& sample : head.samples)
        if (sample.cell_id == 17)
            sample.wall_ns *= 3;
    analyse(base);
    analyse(head);
    EXPECT_EQ(exit_of(base, base), exit_success);
    EXPECT_EQ(exit_of(base, head, 0.05), exit_failed);
}

TEST(CompareCommand, AnEditedFileIsNamedOnTop) {
    auto head = timed(100);
    head.is_sealed = false;
    EXPECT_THAT(text_of(timed(100), head), HasSubstr("\nhead: 0123456789ab on ?, ?\n  THIS FILE"));
    EXPECT_THAT(comparison_json(head, head, compare_files(head, head)),
                HasSubstr("\"sealed\": {\"base\": false, \"head\": false}"));
}

TEST(CompareCommand, AnEditedFileNeverPassesAndMayFail) {
    for (const bool is_base : {true, false}) {
        auto base = timed(100), head = timed(100), slower = timed(150);
        (is_base ? base : head).is_sealed = slower.is_sealed = false;
        EXPECT_EQ(exit_of(base, head), exit_cannot_tell);
        EXPECT_THAT(text_of(base, head),
                    StartsWith("CAN'T TELL: a file was changed after it was written"));
        EXPECT_EQ(exit_of(base, slower), exit_failed);
    }
}

TEST(CompareCommand, JsonHasEveryRowAndItsReason) {
    const auto base = timed(100, 3), head = timed(110, 3);
    const std::string json = comparison_json(base, head, compare_files(base, head));
    EXPECT_THAT(json, HasSubstr("\"cell\": \"soup/ours\", \"phase\": \"query\", \"n_pairs\": 3"));
    EXPECT_THAT(json, HasSubstr("\"verdict\": \"cannot_tell\", \"reason\": \"too_few_rounds\""));
    EXPECT_THAT(json, HasSubstr("\"ci_lo\": null"));
}

TEST(CompareCommand, SaysWhatItSaw) {
    const std::string slower = text_of(timed(100), timed(110));
    EXPECT_THAT(slower, HasSubstr("0123456789ab"));
    EXPECT_THAT(slower, HasSubstr("soup/ours  query       9  100 ns  110 ns       1.10"));
    EXPECT_THAT(
        slower,
        StartsWith("REGRESSION: 1 of 1 timings slower; together 1.10x (1.10 to 1.10), worst "
                   "1.10x: soup/ours, query\n"));
    EXPECT_THAT(text_of(timed(100), timed(101)),
                StartsWith("FINE: none of 1 timings is slower by more than 5 %; together 1.01x"));
    EXPECT_THAT(slower, Not(HasSubstr("more rounds")));
    const std::string few = text_of(timed(100, 3), timed(110, 3));
    EXPECT_THAT(few, StartsWith("CAN'T TELL: 1 of 1 timings may be slower by more than 5 %; "));
    EXPECT_THAT(few, HasSubstr("can't tell (too few rounds)"));
    EXPECT_THAT(few, HasSubstr("at least 9 rounds"));
    EXPECT_THAT(text_of(timed(100), timed(110), {.markdown = true}),
                HasSubstr("| cell | phase | rounds | base | head | head/base |"));
    EXPECT_THAT(text_of(timed(100), timed(100, 9, results::Status::wrong)),
                StartsWith("REGRESSION: the answers of 1 cell newly wrong\n"));
}

} // namespace
} // namespace boxwood::bench
