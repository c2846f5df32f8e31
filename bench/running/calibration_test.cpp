#include "bench/running/calibration.h"

#include "bench/running/inputs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

namespace boxwood::bench {
namespace {

TEST(Calibration, RepeatsUntilTheTargetIsReached) {
    EXPECT_EQ(iterations_for(1e6, 1e6), 1u);
    EXPECT_EQ(iterations_for(1e6, 5e8), 1u); // slower than a sample: once
    EXPECT_EQ(iterations_for(1e6, 0.4e6), 3u);
    EXPECT_EQ(iterations_for(1e6, 10), 100'000u);
    EXPECT_EQ(iterations_for(1e9, 1e-3), 10'000'000u);
    EXPECT_EQ(iterations_for(1e6, 0), 10'000'000u);
    EXPECT_EQ(iterations_for(1e6, std::numeric_limits<double>::infinity()), 1u);
}

TEST(Calibration, ARoundWarmsUpOnce) { EXPECT_EQ(round_ns({2, 3, 10, 100}), 3 * 10 + 4 * 100); }

TEST(Calibration, TextRoundTrips) {
    const Calibrations calibrations{{"a/b", {1, 10'000'000, 0.1, 1.0 / 3}}, {"c", {7, 1, 1e12, 0}}};
    EXPECT_EQ(calibrations_of(to_text(calibrations)), calibrations);
    EXPECT_TRUE(calibrations_of(to_text(Calibrations{})).empty());
    EXPECT_THROW(calibrations_of(""), std::runtime_error);
    EXPECT_THROW(calibrations_of(to_text(calibrations) + "x\n"), std::runtime_error);
}

TEST(Inputs, TextRoundTrips) {
    const InputAnswers answers{{{"a/b", 0}, {~std::uint64_t{0}, 7}}, {{"a/b", 1}, {1, 0}}};
    EXPECT_EQ(input_answers_of(to_text(answers)), answers);
    EXPECT_TRUE(input_answers_of(to_text(InputAnswers{})).empty());
    EXPECT_THROW(input_answers_of(""), std::runtime_error);
    EXPECT_THROW(input_answers_of(to_text(answers) + "x\n"), std::runtime_error);
}

/// Cells "c0", "c1", ... each of a variant of its own.
struct Cells {
    results::Results prepared;
    Calibrations calibrations;

    void add(bool is_peer, double query_ns, results::Status status) {
        const auto id = static_cast<std::uint32_t>(prepared.cells.size());
        results::Variant variant;
        variant.variant_id = id;
        variant.is_peer = is_peer;
        prepared.variants.push_back(variant);
        results::Cell cell;
        cell.cell_id = cell.variant_id = id;
        cell.name = "c" + std::to_string(id);
        prepared.cells.push_back(cell);
        results::Check check;
        check.cell_id = id;
        check.status = status;
        prepared.checks.push_back(check);
        calibrations[cell.name] = {1, 1, 1, query_ns};
    }
    std::set<std::string> twins() const { return choose_twins(prepared, calibrations); }
};

TEST(Twins, AreTheCheapestOfEachKind) {
    Cells cells;
    using Names = std::set<std::string>;
    EXPECT_EQ(cells.twins(), Names{});
    cells.add(true, 2e6, results::Status::exact);
    EXPECT_EQ(cells.twins(), Names{"c0"}); // though it is all of the round
    for (int i = 0; i < 40; ++i)
        cells.add(true, 3e6, results::Status::exact);
    cells.add(false, 1e4, results::Status::exact); // c41
    cells.add(false, 1e5, results::Status::exact);
    cells.add(false, 9e6, results::Status::exact);
    cells.add(false, 3e6, results::Status::exact); // c44
    const auto with = [](Names names) {            // and those farther up the order of their kind
        names.insert({"c18", "c27", "c42"});       // equal peers stand in order of their names
        return names;
    };
    EXPECT_EQ(cells.twins(), with({"c0", "c41", "c44"}));
    cells.add(false, 5e6, results::Status::exact);
    cells.prepared.cells.back().threads = 2;
    EXPECT_EQ(cells.twins(), with({"c0", "c41", "c44", "c45"}));
    cells.add(false, 2e6, results::Status::wrong);
    EXPECT_EQ(cells.twins(), with({"c0", "c41", "c44", "c45"}));
    cells.calibrations.erase("c44"); // not timed
    EXPECT_EQ(cells.twins(), with({"c0", "c41", "c43", "c45"}));
    cells.add(false, 1e9, results::Status::exact); // of its kind alone, but too dear
    cells.prepared.cells.back().threads = 4;
    cells.calibrations["c45"].query_ns = 2e9;
    EXPECT_EQ(cells.twins(), with({"c0", "c41", "c43"}));
}

TEST(Twins, AreThreeOfAKindWhileTheyTakeATenth) {
    Cells cells;
    for (int i = 0; i < 8; ++i)
        cells.add(false, 1e5 + i, results::Status::exact);
    const std::set<std::string> cheapest{"c0"};
    EXPECT_EQ(cells.twins(), cheapest); // of few, one is more than a tenth
    for (int i = 8; i < 40; ++i)
        cells.add(false, 1e5 + i, results::Status::exact);
    EXPECT_EQ(cells.twins(), (std::set<std::string>{"c0", "c10", "c20"}));
    EXPECT_EQ(choose_twins(cells.prepared, cells.calibrations, {"c10"}),
              (std::set<std::string>{"c0", "c11", "c21"}));
    EXPECT_TRUE(choose_twins(cells.prepared, cells.calibrations, {}, {"c33"}).contains("c33"));
}

} // namespace
} // namespace boxwood::bench
