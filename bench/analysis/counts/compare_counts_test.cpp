#include "bench/analysis/counts/compare_counts.h"

#include "bench/analysis/status.h"
#include "bench/commands/compare_counts.h"
#include "bench/testing/maker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>

namespace boxwood::bench {
namespace {

using results::Results;

/// Two cells of ours and a peer, with the counters of a sweep.
Results with_counts() {
    Maker maker(0);
    for (const char* name : {"ours0", "ours1", "peer"}) {
        const std::uint32_t id = maker.cell(name, std::string_view(name) == "peer");
        for (const auto& [counter, value] :
             {std::pair{"node_visits", 500u}, {"bytes", 10000u}, {"instructions_query", 100000u}})
            maker.results.counters.push_back({id, counter, value});
    }
    maker.results.texts["instructions_by"] = "valgrind-3, AVX2";
    set_statuses(maker.results);
    return maker.results;
}

/// A copy in which a counter of a cell is another.
Results changed(std::uint32_t cell, std::string_view counter, std::uint64_t value) {
    Results edited = with_counts();
    for (auto& row : edited.counters)
        if (row.cell_id == cell && row.counter == counter)
            row.value = value;
    return edited;
}

Results with_status(std::uint32_t cell, results::Status status) {
    Results edited = with_counts();
    edited.cells[cell].status = status;
    return edited;
}

std::string verdict_of(const Results& base, const Results& head, const CountOptions& options = {}) {
    const std::string text = counts_text(base, head, compare_counts(base, head, options), options);
    return text.substr(0, text.find('\n'));
}

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(CompareCounts, AnEditedFileNeverPasses) {
    Results head = with_counts();
    head.is_sealed = false;
    EXPECT_EQ(compare_counts(with_counts(), head).gate, Gate::open);
    EXPECT_THAT(verdict_of(with_counts(), head),
                StartsWith("CAN'T TELL: a file was changed after it was written"));
}

TEST(CompareCounts, EqualFilesPass) {
    const CountComparison same = compare_counts(with_counts(), with_counts());
    EXPECT_EQ(same.gate, Gate::passes);
    EXPECT_EQ(same.rows.size(), 6u); // of ours alone
    EXPECT_EQ(verdict_of(with_counts(), with_counts()),
              "FINE: none of 6 counts is more (of instructions and bytes by more than 1 %)");
}

TEST(CompareCounts, OneNodeVisitMoreFails) {
    const Results head = changed(1, "node_visits", 501);
    EXPECT_EQ(compare_counts(with_counts(), head).gate, Gate::fails);
    EXPECT_THAT(verdict_of(with_counts(), head),
                AllOf(StartsWith("REGRESSION: 1 of 6 counts more"),
                      HasSubstr("; worst +0.20 %: ours1, node_visits")));
}

TEST(CompareCounts, InstructionsAndBytesHaveALimit) {
    for (const auto& [counter, base] :
         {std::pair{"instructions_query", 100000u}, {"bytes", 10000u}})
        for (const auto& [share, gate] :
             {std::pair{1.005, Gate::passes}, {1.01, Gate::passes}, {1.02, Gate::fails}}) {
            const Results head = changed(0, counter, static_cast<std::uint64_t>(base * share));
            EXPECT_EQ(compare_counts(with_counts(), head).gate, gate) << counter << share;
        }
    const Results head = changed(0, "instructions_query", 102000);
    EXPECT_EQ(compare_counts(with_counts(), head, {.more = 0.03}).gate, Gate::passes);
    EXPECT_EQ(compare_counts(with_counts(), head, {.more = 0}).gate, Gate::fails);
}

TEST(CompareCounts, FewerIsNewsAndPasses) {
    for (const char* counter : {"node_visits", "instructions_query"}) {
        const CountComparison fewer = compare_counts(with_counts(), changed(0, counter, 400));
        EXPECT_EQ(fewer.gate, Gate::passes);
        EXPECT_EQ(std::ranges::count(fewer.rows, CountRow::Change::fewer, &CountRow::change), 1);
    }
}

TEST(CompareCounts, WhatIsExpectedPassesAndIsSaid) {
    const Results head = changed(0, "node_visits", 600);
    const auto expecting = [](const char* what) {
        return CountOptions{.expected = [what](const std::string& name) { return name == what; }};
    };
    const CountOptions options = expecting("ours0 node_visits");
    const CountComparison expected = compare_counts(with_counts(), head, options);
    EXPECT_EQ(expected.gate, Gate::passes);
    EXPECT_THAT(counts_text(with_counts(), head, expected, options),
                HasSubstr("more, as expected"));
    EXPECT_EQ(compare_counts(with_counts(), head, expecting("ours1 node_visits")).gate,
              Gate::fails);
}

TEST(CompareCounts, ThePeersCountForNothing) {
    EXPECT_EQ(compare_counts(with_counts(), changed(2, "node_visits", 900)).gate, Gate::passes);
}

TEST(CompareCounts, OnlyWhatIsWanted) {
    const CountOptions options{.wanted = [](const std::string& cell) { return cell == "ours1"; }};
    EXPECT_EQ(compare_counts(with_counts(), changed(0, "node_visits", 900), options).gate,
              Gate::passes);
    EXPECT_EQ(compare_counts(with_counts(), changed(1, "node_visits", 900), options).gate,
              Gate::fails);
}

TEST(CompareCounts, WhatIsLostCannotBeTold) {
    Results head = with_counts();
    std::erase_if(head.counters,
                  [](const auto& row) { return row.cell_id == 0 && row.counter == "bytes"; });
    const CountComparison lost = compare_counts(with_counts(), head);
    EXPECT_EQ(lost.gate, Gate::open);
    EXPECT_THAT(lost.lost, ElementsAre(Lost{"ours0", "no bytes"}));

    head = with_counts();
    head.cells[1].name = "another";
    const CountComparison renamed = compare_counts(with_counts(), head);
    EXPECT_THAT(renamed.lost, ElementsAre(Lost{"ours1", "no such cell"}));
    EXPECT_THAT(renamed.only_head, ElementsAre("another"));
    EXPECT_EQ(renamed.gate, Gate::open);

    head = with_counts();
    head.scenes[0].content_hash ^= 1;
    EXPECT_THAT(verdict_of(with_counts(), head),
                AllOf(StartsWith("CAN'T TELL: 2 of the base's"), HasSubstr("no counter of ours")));
    EXPECT_EQ(compare_counts(with_counts(), with_status(0, results::Status::unchecked)).gate,
              Gate::open);
}

TEST(CompareCounts, AnAnswerNewlyWrongFails) {
    const Results head = with_status(0, results::Status::wrong);
    const CountComparison wrong = compare_counts(with_counts(), head);
    EXPECT_EQ(wrong.gate, Gate::fails);
    EXPECT_THAT(wrong.newly_wrong, ElementsAre("ours0"));
    EXPECT_THAT(verdict_of(with_counts(), head), HasSubstr("answers of 1 cell newly wrong"));
    EXPECT_EQ(compare_counts(head, head).gate, Gate::passes); // of a kernel without a promise
}

TEST(CompareCounts, WithoutInstructionsItCannotTell) {
    Results base = with_counts();
    base.texts.erase("instructions_by");
    for (const Results& head : {base, with_counts()}) {
        EXPECT_EQ(compare_counts(base, head).gate, Gate::open);
        EXPECT_THAT(verdict_of(base, head),
                    StartsWith("CAN'T TELL: no instructions were counted in the base: boxwood "
                               "sweep --count does"));
    }
}

TEST(CompareCounts, InstructionsOfAnotherCounterAreOpen) {
    Results head = with_counts();
    head.texts["instructions_by"] = "valgrind-4, AVX2";
    EXPECT_EQ(compare_counts(with_counts(), head).gate, Gate::open);
    EXPECT_THAT(verdict_of(with_counts(), head),
                StartsWith("CAN'T TELL: instructions were counted by valgrind-3, AVX2 and by "
                           "valgrind-4, AVX2"));
}

} // namespace
} // namespace boxwood::bench
