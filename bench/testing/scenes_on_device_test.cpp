/// Scenes that are played on a device, on the host's model of one.

#include "bench/commands/plan.h"
#include "bench/io/bad_input.h"
#include "bench/plan/plan.h"
#include "bench/running/prepare.h"
#include "bench/running/round.h"
#include "bench/stages/device_bodies.h"
#include "bench/stages/scene_player.h"
#include "scenes/moving/frames.h"
#include "trees/cuda/launch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <map>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

SceneFile file_of(const std::string& text, std::size_t n) {
    SceneFile file = parse_scene_file(text, "mine.toml");
    file.n = n;
    return file;
}

const std::string bodies = "[[bodies]]\ngenerator = \"uniform\"\n";
const std::string steps = "effects = [\"drift\", {name = \"brownian\", share = 0.4}, "
                          "{name = \"teleport\", share = 0.6, often = 0.3}, "
                          "{name = \"swarm\", share = 0.3, flock = 7}, "
                          "{name = \"gravity\", share = 0.7, strength = 300, bounce = 0.1}]\n";

/// By bits: a zero is not its negative.
std::vector<std::array<std::uint32_t, 6>> bits_of(std::span<const Box> boxes) {
    std::vector<std::array<std::uint32_t, 6>> all;
    for (const Box& box : boxes)
        all.push_back(std::bit_cast<std::array<std::uint32_t, 6>>(box));
    return all;
}

std::vector<Box> to_host(DeviceSpan<const Box> boxes) {
    std::vector<Box> all(boxes.size);
    cuda::download(boxes.data, std::span(all), {});
    return all;
}

TEST(DeviceBodies, HaveTheBoxesOfTheHostFrameByFrame) {
    const std::string drift = "effects = \"drift\"\n", teleport = "effects = \"teleport\"\n",
                      gravity = "effects = {name = \"gravity\", turn = 1}\n";
    for (const std::string& effects : {std::string(), drift, teleport, gravity, steps})
        for (const std::size_t n : {1, 2, 15, 16, 17, 255, 256, 257, 4097}) {
            SCOPED_TRACE(effects + std::to_string(n));
            on_host::set_seed(n);
            MovingScene scene(file_of(bodies + effects, n)), clock(scene.file());
            const auto there = make_device_bodies({});
            EXPECT_GE(there->upload(clock), n * (sizeof(Box) + sizeof(Vec3<double>)));
            for (int frame = 0; frame < (n > 300 ? 3 : 10); ++frame) {
                ASSERT_EQ(bits_of(to_host(there->fit())), bits_of(boxes_of(scene)));
                scene.advance();
                clock.begin_frame(); // and nothing else: its bodies stay at the start
                for (std::size_t i = 0; i < clock.effects().size(); ++i)
                    there->advance(clock, i);
                there->move(clock);
            }
        }
}

std::unique_ptr<ScenePlayer> player_of(const SceneFile& file, Where where) {
    return std::make_unique<ScenePlayer>(MovingScene(file, {}, true), Extent::required, serial(),
                                         where);
}

/// From the start through so many further frames, as on the host.
void expect_the_same(ScenePlayer& there, const SceneFile& file, int frames) {
    const auto here = player_of(file, Where::host);
    here->start();
    there.start();
    for (int frame = 0; frame <= frames; ++frame) {
        if (frame > 0) {
            here->advance();
            there.advance();
        }
        ASSERT_EQ(answers_hash(there.query()), answers_hash(here->query())) << frame;
        ASSERT_EQ(there.answers().pairs.size(), here->answers().pairs.size());
    }
}

TEST(ScenesOnDevice, AnswerAsOnTheHost) {
    std::vector<std::string> played, resident;
    for (const BuiltInScene& entry : built_in_scenes()) {
        SCOPED_TRACE(entry.name);
        SceneFile file = load_scene(std::string(entry.name));
        file.n = 60;
        for (const Where where : {Where::device, Where::resident}) {
            if (why_not(MovingScene(file), Extent::required, where))
                continue;
            (where == Where::device ? played : resident).push_back(std::string(entry.name));
            expect_the_same(*player_of(file, where), file, 3);
        }
    }
    EXPECT_EQ(played.size(), 16u); // but for crowd, whose bodies come and go, and fly_through
    EXPECT_THAT(resident,
                testing::IsSupersetOf({"popcorn", "still_life", "drone_swarm", "broadmark_brownian",
                                       "broadmark_free_fall", "broadmark_gravity_assorted"}));
}

/// The rows of the ledger that have calls: stage and calls.
std::vector<std::pair<std::string, std::uint64_t>> calls_of(ScenePlayer& player) {
    std::vector<std::pair<std::string, std::uint64_t>> all;
    for (const LedgerRow& row : player.ledger().rows())
        if (row.calls > 0)
            all.emplace_back(row.stage, row.calls);
    return all;
}

TEST(ScenesOnDevice, TheLedgerShowsEachCrossing) {
    const SceneFile file = file_of(bodies + "effects = \"drift\"\n", 300);
    auto there = player_of(file, Where::device);
    expect_the_same(*there, file, 2);
    expect_the_same(*there, file, 4); // from frame 0 again
    using Calls = std::vector<std::pair<std::string, std::uint64_t>>;
    EXPECT_EQ(calls_of(*there), (Calls{{"advance_drift", 4},
                                       {"move", 4},
                                       {"fit", 5},
                                       {"upload", 5},
                                       {"tree", 1},
                                       {"update", 4},
                                       {"pairs", 5},
                                       {"download", 5}}));
    const LedgerRow &up = there->ledger().row("upload"), down = there->ledger().row("download");
    EXPECT_EQ(up.items, 5u * 300);
    EXPECT_EQ(up.bytes, 5u * 300 * sizeof(Box));
    EXPECT_EQ(down.items, there->ledger().row("pairs").items);
    EXPECT_EQ(down.bytes, down.items * sizeof(Pair));

    // Only the answers come down: bodies go up once.
    there = player_of(file, Where::resident);
    expect_the_same(*there, file, 2);
    expect_the_same(*there, file, 4);
    EXPECT_EQ(calls_of(*there), (Calls{{"upload", 1},
                                       {"advance_drift", 4},
                                       {"move", 4},
                                       {"fit", 5},
                                       {"tree", 1},
                                       {"update", 4},
                                       {"pairs", 5},
                                       {"download", 5}}));
    EXPECT_EQ(there->ledger().row("upload").bytes, 300 * (sizeof(Box) + 2 * sizeof(Vec3<double>)));
    EXPECT_EQ(there->ledger().row("download").items, there->ledger().row("pairs").items);
}

TEST(ScenesOnDevice, WhatDoesNotChangeCrossesOnce) {
    for (const Where where : {Where::device, Where::resident}) {
        const SceneFile file = file_of(bodies, 300);
        const auto there = player_of(file, where);
        expect_the_same(*there, file, 3);
        const Ledger& ledger = there->ledger();
        EXPECT_EQ(ledger.row("upload").calls, 1u);
        EXPECT_EQ(ledger.row("update").calls, 0u);
        EXPECT_EQ(ledger.row("download").items, there->answers().pairs.size());
        EXPECT_FALSE(there->answers().pairs.empty());
    }
}

TEST(ScenesOnDevice, WhatHasNoFormThereIsNamed) {
    const auto why = [](const std::string& text, Where where) {
        return why_not(MovingScene(file_of(text, 50)), Extent::required, where).value_or("");
    };
    EXPECT_EQ(why(bodies + "effects = [\"drift\", \"orbit\"]\n", Where::resident),
              "stage advance_orbit has no device form");
    EXPECT_EQ(why(bodies + "effects = [\"drift\", \"orbit\"]\n", Where::device), "");
    EXPECT_EQ(why(bodies + "effects = \"spawn\"\n", Where::device),
              "stage tree has no device form where bodies come and go");
    EXPECT_EQ(why(bodies + "margin = 1\n", Where::resident),
              "stage fit has no device form where margins widen boxes");
    EXPECT_EQ(why(bodies + "group_ignored = true\n", Where::resident),
              "stage filter has no device form");
    EXPECT_EQ(why(bodies + "group_ignored = true\n", Where::device), "");
    EXPECT_THAT(why("queries = \"rays\"\n" + bodies, Where::device),
                HasSubstr("does not need pairs"));
    EXPECT_THROW(ScenePlayer(MovingScene(file_of(bodies + "effects = \"spin\"\n", 50)),
                             Extent::required, serial(), Where::resident),
                 std::invalid_argument);
}

/// Cells of both places are right, with a ledger of their own, or say why they are not there.
TEST(ScenesOnDevice, ASweepHasThemAsCells) {
    const Report silent = [](std::size_t, std::size_t, const std::string&) {};
    const Plan plan = make_plan(
        "rounds = 1\nmin_time_ms = 0.01\nthreads = 1\n[[cells]]\ntask = \"scene_queries\"\n"
        "scene = [\"popcorn\", \"rubble\"]\nn = 60\nframes = 3\n"
        "stages = [\"required\", \"all_stages\"]\n"
        "executors = [\"serial\", \"cuda\", \"cuda_resident\"]\n",
        "scenes.toml", {});
    results::Env env;
    env.env_hash = "machine";
    const results::Results all = prepare(plan, env, {}, silent);
    ASSERT_EQ(all.checks.size(), 12u);
    std::map<std::string, std::string> not_there; // by scene, way and executor
    for (const results::Check& check : all.checks) {
        const results::Cell& cell = all.cells[check.cell_id];
        if (check.status == results::Status::unsupported)
            not_there[cell.name.substr(0, 6) + cell.executor] += check.witness + "; ";
        else
            EXPECT_EQ(check.status, results::Status::exact) << cell.name << ": " << check.witness;
    }
    const std::string all_stages = "all stages have no device form; ";
    EXPECT_THAT(not_there,
                testing::ElementsAre(
                    testing::Pair("popcorcuda", all_stages),
                    testing::Pair("popcorcuda_resident", all_stages),
                    testing::Pair("rubblecuda", all_stages),
                    testing::Pair("rubblecuda_resident",
                                  "stage advance_spin has no device form; " + all_stages)));
    const results::Results round = run_round(plan, all, 0, silent);
    for (const results::Sample& sample : round.samples)
        EXPECT_EQ(sample.flags & results::wrong_answer, 0u);
    std::map<std::string, std::uint64_t> uploads; // calls, by executor
    for (const results::EffectRow& row : round.effects)
        if (row.stage == "upload")
            uploads[all.cells[row.cell_id].executor] += row.calls;
    EXPECT_THAT(uploads, testing::ElementsAre(testing::Pair("cuda", 2u * 4),
                                              testing::Pair("cuda_resident", 1u)));
}

TEST(ScenesOnDevice, ThePlanSaysWhatStaysThere) {
    const auto text = [](const std::string& name) {
        SceneFile file = load_scene(name);
        file.n = 200;
        const MovingScene scene(file);
        const Where where = where_on_device(scene);
        return plan_text(scene, Extent::required, false, where) +
               played_text(file, 2, serial(), where);
    };
    EXPECT_THAT(text("popcorn"), HasSubstr("the bodies stay there, and pairs come down"));
    EXPECT_THAT(text("rubble"), HasSubstr("boxes go up and pairs come down in each frame, as stage "
                                          "advance_spin has no device form"));
    EXPECT_THROW(text("crowd"), BadInput);
}

} // namespace
} // namespace boxwood::bench
