#include "results/results.h"
#include "results/testing/example.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace boxwood::results {
namespace {

std::string merge_error(std::span<const Results> parts, std::span<const std::string> names = {}) {
    try {
        merge(parts, names);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

/// One machine, one round, a scene, two variants, a cell of each with one sample.
Results part(const std::string& machine, std::uint32_t round, std::uint32_t first_id = 0) {
    Results p;
    p.run_uuid = "run of " + machine;
    p.sweep_hash = "sweep";
    p.texts = {{"sweep_toml", "rounds = 9"}, {"lscpu", machine}};
    p.env.resize(1);
    p.env[0].env_id = first_id + 5;
    p.env[0].env_hash = machine;
    p.packages.resize(1);
    p.packages[0].env_id = first_id + 5;
    p.packages[0].library = "fcl";
    p.scenes.resize(1);
    p.scenes[0].scene_id = first_id + 7;
    p.scenes[0].name = "soup";
    p.scenes[0].content_hash = 99;
    p.shards.resize(1);
    p.shards[0].shard_id = first_id + 2;
    p.shards[0].env_id = first_id + 5;
    p.shards[0].round = round;
    p.shards[0].pid = 1234;
    for (std::uint32_t i = 0; i < 2; ++i) {
        const std::string name = i == 0 ? "ours" : "peer";
        Variant variant;
        variant.variant_id = first_id + i;
        variant.name = name;
        p.variants.push_back(variant);
        Cell cell;
        cell.cell_id = first_id + 40 - i;
        cell.name = "soup/" + name;
        cell.scene_id = first_id + 7;
        cell.variant_id = first_id + i;
        p.cells.push_back(cell);
        Sample sample;
        sample.cell_id = cell.cell_id;
        sample.shard_id = first_id + 2;
        sample.round = round;
        sample.phase = Phase::query;
        sample.wall_ns = 100.0 * (i + 1) + round;
        p.samples.push_back(sample);
        FrameRow frame;
        frame.cell_id = cell.cell_id;
        frame.shard_id = first_id + 2;
        frame.round = round;
        if (round == 0) {
            frame.box_tests = 50 + static_cast<std::uint64_t>(i);
            frame.sah = 0.5 + static_cast<double>(i);
        }
        p.frames.push_back(frame);
        for (const char* stage : {"update", "pairs"}) {
            EffectRow effect;
            effect.cell_id = cell.cell_id;
            effect.shard_id = first_id + 2;
            effect.round = round;
            effect.stage = stage;
            effect.total_ns = 10.0 * (i + 1) + round;
            p.effects.push_back(effect);
        }
        Counter counter;
        counter.cell_id = cell.cell_id;
        counter.counter = "pairs";
        counter.value = 7;
        p.counters.push_back(counter);
        Check check;
        check.cell_id = cell.cell_id;
        check.oracle = "brute_force";
        check.status = Status::exact;
        p.checks.push_back(check);
        TreeRow tree;
        tree.cell_id = cell.cell_id;
        p.trees.push_back(tree);
    }
    Comparison comparison;
    comparison.cell_a = first_id + 39;
    comparison.cell_b = first_id + 40;
    comparison.phase = Phase::query;
    p.compare.push_back(comparison);
    return p;
}

TEST(Merge, AFileWithItselfIsItself) {
    const Results once = merge(std::array{part("a", 0)});
    EXPECT_EQ(difference(once, merge(std::array{part("a", 0), part("a", 0)})), "");
    EXPECT_EQ(difference(once, merge(std::array{once, once})), "");
    EXPECT_EQ(once.samples.size(), 2u);
    EXPECT_EQ(once.cells[0].scene_id, 0u);
}

TEST(Merge, RoundsAddUpWhateverTheIds) {
    const Results all = merge(std::array{part("a", 0), part("a", 1, 100), part("a", 2, 31)});
    EXPECT_EQ(all.env.size(), 1u);
    EXPECT_EQ(all.scenes.size(), 1u);
    EXPECT_EQ(all.variants.size(), 2u);
    EXPECT_EQ(all.cells.size(), 2u);
    EXPECT_EQ(all.shards.size(), 3u);
    EXPECT_EQ(all.counters.size(), 2u);
    EXPECT_EQ(all.checks.size(), 2u);
    EXPECT_EQ(all.trees.size(), 2u);
    EXPECT_EQ(all.packages.size(), 1u);
    EXPECT_TRUE(all.compare.empty()); // derived: made again by who writes the file
    EXPECT_EQ(all.sweep_hash, "sweep");
    ASSERT_EQ(all.samples.size(), 6u);
    for (const Sample& sample : all.samples) {
        const double base = all.cells.at(sample.cell_id).name == "soup/ours" ? 100 : 200;
        EXPECT_EQ(sample.wall_ns, base + sample.round);
        EXPECT_EQ(all.shards.at(sample.shard_id).round, sample.round);
    }
    EXPECT_EQ(all.frames.size(), 6u);
    for (const FrameRow& frame : all.frames) {
        const std::uint64_t i = all.cells.at(frame.cell_id).name == "soup/ours" ? 0 : 1;
        EXPECT_EQ(frame.box_tests, frame.round == 0 ? 50 + i : no_count);
        EXPECT_THAT(frame.sah, testing::NanSensitiveDoubleEq(
                                   frame.round == 0 ? 0.5 + static_cast<double>(i) : missing));
    }
    ASSERT_EQ(all.effects.size(), 12u);
    for (const EffectRow& effect : all.effects) {
        const double base = all.cells.at(effect.cell_id).name == "soup/ours" ? 10 : 20;
        EXPECT_EQ(effect.total_ns, base + effect.round);
        EXPECT_EQ(all.shards.at(effect.shard_id).round, effect.round);
    }
}

TEST(Merge, TimesOfTwoProcessorModelsAreNeverPooled) {
    Results a = part("a", 0), b = part("b", 1);
    a.env[0].cpu = "one";
    b.env[0].cpu = "other";
    const std::vector<std::string> names{"a.h5", "b.h5"};
    EXPECT_EQ(merge_error(std::array{a, b}, names),
              "cannot merge: b.h5 was measured on 'other', those before it on 'one'; times of two "
              "processor models are never pooled: keep a file for each");
    b.env[0].cpu = "one"; // two machines of one model
    EXPECT_EQ(merge_error(std::array{a, b}, names), "");
    b.env[0].isa_max = "AVX2"; // two models of one name
    a.env[0].isa_max = "AVX3";
    EXPECT_EQ(merge_error(std::array{a, b}, names),
              "cannot merge: b.h5 was measured on 'one, AVX2', those before it on 'one, AVX3'; "
              "times of two processor models are never pooled: keep a file for each");
}

TEST(Merge, MachinesStayApart) {
    Results b = part("b", 0);
    b.sweep_hash = "other";
    const Results all = merge(std::array{part("a", 0), b});
    EXPECT_EQ(all.env.size(), 2u);
    ASSERT_EQ(all.shards.size(), 2u);
    EXPECT_NE(all.shards[0].env_id, all.shards[1].env_id);
    EXPECT_EQ(all.samples.size(), 4u);
    EXPECT_EQ(all.cells.size(), 2u);
    EXPECT_EQ(all.sweep_hash, "mixed");
    EXPECT_EQ(all.run_uuid, "run of a");
    const std::map<std::string, std::string> texts{
        {"sweep_toml", "rounds = 9"}, {"lscpu", "a"}, {"lscpu.2", "b"}};
    EXPECT_EQ(all.texts, texts);
    EXPECT_EQ(difference(all, merge(std::array{all, b})), "");
}

TEST(Merge, AMachineWithADeviceStaysApartFromOneWithout) {
    Results with = part("a with a device", 0);
    with.env[0].gpu = "H200";
    with.shards[0].gpu_copy_gbs = 4300;
    with.cells[0].executor = device_executor;
    with.cells[0].name += "/cuda-1";
    for (const bool swapped : {false, true}) {
        const Results without = part("a", 0, 100);
        const Results all = merge(std::array{swapped ? without : with, swapped ? with : without});
        ASSERT_EQ(all.env.size(), 2u);
        ASSERT_EQ(all.cells.size(), 3u); // the peer's is one
        EXPECT_EQ(std::ranges::count_if(all.cells, is_device), 1);
        EXPECT_EQ(all.samples.size(), 4u);
        for (const Shard& shard : all.shards) {
            EXPECT_EQ(all.env.at(shard.env_id).gpu.empty(), std::isnan(shard.gpu_copy_gbs));
            EXPECT_EQ(shard.env_id, shard.shard_id);
        }
    }
}

TEST(Merge, AnotherVersionIsAnotherVariant) {
    Results b = part("b", 0);
    b.variants[1].lib_version = "9.9";
    const Results all = merge(std::array{part("a", 0), b});
    EXPECT_EQ(all.variants.size(), 3u);
    EXPECT_EQ(all.cells.size(), 3u);
}

TEST(Merge, TheWorseCheckStays) {
    for (const bool swapped : {false, true}) {
        std::array parts{part("a", 0), part("a", 1)};
        parts[swapped].checks[0].status = Status::wrong;
        parts[swapped].checks[0].witness = "pair 3,4";
        const Results all = merge(parts);
        EXPECT_EQ(all.checks[0].status, Status::wrong);
        EXPECT_EQ(all.checks[0].witness, "pair 3,4");
        EXPECT_EQ(all.checks[0].cell_id, 0u);
    }
}

TEST(Merge, TheWorseKernelRowStays) {
    for (const bool swapped : {false, true}) {
        std::array parts{part("a", 0), part("a", 1)};
        for (Results& p : parts) {
            KernelRow row;
            row.cell_id = p.cells[0].cell_id;
            row.family = "slivers";
            row.status = Status::exact;
            p.kernels = {row};
        }
        parts[swapped].kernels[0].status = Status::wrong;
        parts[swapped].kernels[0].witness = "case 3";
        const Results all = merge(parts);
        ASSERT_EQ(all.kernels.size(), 1u);
        EXPECT_EQ(all.kernels[0].status, Status::wrong);
        EXPECT_EQ(all.kernels[0].witness, "case 3");
    }
}

TEST(Merge, OnePartThatIsChangedOrUnfinishedMarksAll) {
    for (const bool swapped : {false, true}) {
        std::array parts{part("a", 0), part("a", 1)};
        EXPECT_TRUE(merge(parts).is_sealed);
        EXPECT_TRUE(merge(parts).complete);
        parts[swapped].is_sealed = false;
        parts[swapped].complete = false;
        EXPECT_FALSE(merge(parts).is_sealed);
        EXPECT_FALSE(merge(parts).complete);
    }
}

TEST(Merge, OtherContentUnderTheSameNameIsAnError) {
    std::array parts{part("a", 0), part("b", 0)};
    parts[1].scenes[0].content_hash = 98;
    EXPECT_NE(merge_error(parts).find("soup/ours"), std::string::npos);
}

TEST(Merge, OneShardWithTwoContentsIsAnErrorThatNamesBothParts) {
    const std::array<std::string, 3> names{"a.h5", "b.h5", "c.h5"};
    const auto error_of = [&](const auto& change) {
        std::array parts{part("a", 1), part("a", 0), part("a", 1, 100)};
        change(parts[2]);
        return merge_error(parts, names);
    };
    EXPECT_EQ(error_of([](Results&) {}), "");
    const auto names_both = testing::HasSubstr("a.h5 and c.h5 hold the same shard (round 1");
    EXPECT_THAT(error_of([](Results& p) { p.samples[0].wall_ns += 1; }), names_both);
    EXPECT_THAT(error_of([](Results& p) { p.samples[1].flags = wrong_answer; }), names_both);
    EXPECT_THAT(error_of([](Results& p) { p.samples.pop_back(); }), names_both);
    EXPECT_THAT(error_of([](Results& p) { p.samples.clear(); }), names_both);
}

TEST(Merge, DanglingAndDoubleIdsAreErrors) {
    std::array parts{part("a", 0)};
    parts[0].samples[1].cell_id = 77;
    EXPECT_NE(merge_error(parts).find("id 77, which cells does not have"), std::string::npos);
    parts[0] = part("a", 0);
    parts[0].cells[1].cell_id = parts[0].cells[0].cell_id;
    EXPECT_NE(merge_error(parts).find("cells has id 40 twice"), std::string::npos);
}

TEST(Merge, NothingGivesNothing) {
    EXPECT_EQ(difference(Results{}, merge(std::span<const Results>{})), "");
}

} // namespace
} // namespace boxwood::results
