#include "bench/commands/show.h"

#include "bench/analysis/analyse.h"
#include "bench/analysis/wording.h"
#include "bench/io/text_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Ours, a peer that is right, one that is wrong and one that cannot do it, in nine rounds.
results::Results four_cells() {
    results::Results results;
    results.run_uuid = "the-run";
    results.env.resize(1);
    results.env[0].host = "the-host";
    results.packages.resize(2);
    results.packages[0].library = "fcl";
    results.packages[0].version = "0.7.0";
    results.packages[1].library = "embree";
    results.packages[1].present = 0;
    results.scenes.resize(1);
    results.scenes[0].name = "soup";
    results.scenes[0].n_items = 1000;
    for (std::uint32_t round = 0; round < 9; ++round) {
        results::Shard shard;
        shard.shard_id = shard.round = round;
        results.shards.push_back(shard);
    }
    const char* const names[] = {"binned_sah.wide8", "fcl.tree", "embree.fast", "bullet.dbvt"};
    using results::Status;
    const Status statuses[] = {Status::exact, Status::exact, Status::wrong, Status::unsupported};
    for (std::uint32_t id = 0; id < 4; ++id) {
        results::Variant variant;
        variant.variant_id = id;
        variant.name = names[id];
        variant.library = id == 0 ? "boxwood" : variant.name.substr(0, variant.name.find('.'));
        variant.library_title = variant.library == "fcl" ? "FCL" : variant.library;
        variant.is_peer = id > 0;
        results.variants.push_back(variant);
        results::Cell cell;
        cell.cell_id = cell.variant_id = id;
        cell.task = "pairs";
        cell.n_items = 1000;
        cell.precision = "f32";
        cell.executor = "serial";
        results.cells.push_back(cell);
        results::Check check;
        check.cell_id = id;
        check.status = statuses[id];
        check.missing = id == 2 ? 3 : 0;
        check.n_expected = 70;
        check.witness = id == 2 ? "pair 4,9" : id == 3 ? "no rays" : "";
        results.checks.push_back(check);
        for (std::uint32_t round = 0; round < 9 && id != 3; ++round) {
            results::Sample sample;
            sample.cell_id = id;
            sample.shard_id = sample.round = round;
            sample.phase = results::Phase::query;
            sample.wall_ns = 1000.0 * (id + 1) + round;
            results.samples.push_back(sample);
        }
    }
    results.tasks.push_back({"pairs", "overlapping pairs", results::Phase::build_and_query, ""});
    results.counters.push_back({0, "box_tests", 12345});
    analyse(results);
    return results;
}

TEST(Show, AllSaysWhatIsInTheFile) {
    const std::string text = all_text(four_cells());
    for (const char* part :
         {"the-run", "the-host", "fcl 0.7.0", "embree absent", "9 rounds", "4 cells, 27 samples",
          "soup, 1000 items, pairs, 1 thread\n", "1.00 us", "2.00 us", "box_tests", "12345",
          "wrong, not ranked: embree.fast f32 serial: 3 missing and 0 extra of 70; pair 4,9",
          "unsupported: bullet.dbvt f32 serial: no rays"})
        EXPECT_THAT(text, HasSubstr(part));
    EXPECT_THAT(text,
                ::testing::ContainsRegex("binned_sah.wide8 f32 serial +fcl.tree f32 serial "
                                         "+peers +query +9 +2.00x \\(1.[0-9]+ to 2.[0-9]+\\) +"
                                         "faster"));
    EXPECT_THAT(text, HasSubstr("not ranked: a wrong answer"));
    EXPECT_THAT(text, ::testing::ContainsRegex("overlapping pairs, soup 1k +wins 2.00x over FCL"));
}

TEST(Show, TakesWhatTheFileSaysAndDerivesNothing) {
    results::Results results = four_cells();
    results.medians[0].median_ns = 77e6;
    results.compare[0].words = "as it says";
    results.findings[0].together = "a word of its own";
    EXPECT_THAT(all_text(results), HasSubstr("77.0 ms"));
    EXPECT_THAT(all_text(results), HasSubstr("as it says"));
    EXPECT_THAT(all_text(results), HasSubstr("a word of its own"));
    EXPECT_THAT(json_text(results), HasSubstr("\"together\": \"a word of its own\""));
    EXPECT_THAT(csv_text(results), HasSubstr(",exact,query,9,77000000"));
}

TEST(Show, JsonAndCsvHoldEveryCell) {
    const std::string json = json_text(four_cells()), csv = csv_text(four_cells());
    EXPECT_THAT(json, HasSubstr("\"verdict\": \"faster\", \"reason\": \"\""));
    EXPECT_THAT(json, HasSubstr("\"p_adj\": null")); // of the wrong one
    EXPECT_THAT(json, Not(HasSubstr("nan")));
    EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 3); // timed ones
}

TEST(Show, GoogleBenchmarkGetsARepetitionPerRound) {
    const std::string text = google_benchmark_text(four_cells());
    EXPECT_THAT(text, HasSubstr("\"repetitions\": 9, \"repetition_index\": 8, \"threads\": 1"));
    EXPECT_THAT(text, HasSubstr("\"error_occurred\": true, \"error_message\": \"wrong\""));
    EXPECT_THAT(text, HasSubstr("\"real_time\": 1008, "));
    EXPECT_THAT(text, Not(HasSubstr("nan")));
    EXPECT_THAT(google_benchmark_text({}), HasSubstr("\"benchmarks\": [\n]}"));
}

TEST(Show, AnEmptyFileIsFine) { EXPECT_THAT(all_text({}), HasSubstr("0 cells, 0 samples")); }

TEST(TextTable, AlignsAndEscapes) {
    TextTable table({"name", ">n"});
    table.add({"a|b", "1"});
    table.add({"\u00b5", "234"});
    EXPECT_EQ(table.text(), "name    n\na|b     1\n\u00b5     234\n");
    EXPECT_EQ(table.markdown(), "| name | n |\n| --- | ---: |\n| a\\|b | 1 |\n| \u00b5 | 234 |\n");
}

TEST(TextTable, BytesAndWhatIsNotKnown) {
    EXPECT_EQ(bytes_text(48 << 10), "48 KiB");
    EXPECT_EQ(bytes_text((1u << 20) - 1), "1023 KiB");
    EXPECT_EQ(bytes_text(std::uint64_t{3} << 20), "3 MiB");
    EXPECT_EQ(bytes_text(results::no_count), "?");
    EXPECT_EQ(or_unknown(""), "?");
    EXPECT_EQ(or_unknown("host"), "host");
}

/// The table of examples that the Python scripts are held to as well.
TEST(TextTable, NumbersAreAsTheTableSays) {
    std::ifstream table("scripts/tests/numbers.csv");
    std::string line;
    std::getline(table, line);
    ASSERT_EQ(line, "kind,numbers,text");
    std::set<std::string> kinds;
    while (std::getline(table, line)) {
        const std::size_t first = line.find(','), second = line.find(',', first + 1);
        const std::string kind = line.substr(0, first);
        kinds.insert(kind);
        std::istringstream words(line.substr(first + 1, second - first - 1));
        std::vector<double> numbers;
        for (std::string word; words >> word;)
            numbers.push_back(std::stod(word));
        const std::string text = kind == "time" ? time_text(numbers.at(0))
                                 : kind == "ratio"
                                     ? ratio_text(numbers.at(0))
                                     : interval_text(numbers.at(0), numbers.at(1), numbers.at(2));
        EXPECT_EQ(text, line.substr(second + 1)) << line;
    }
    EXPECT_EQ(kinds, (std::set<std::string>{"time", "ratio", "interval"}));
}

} // namespace
} // namespace boxwood::bench
