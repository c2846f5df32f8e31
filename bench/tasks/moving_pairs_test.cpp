#include "bench/tasks/moving_pairs.h"

#include "bench/io/bad_input.h"
#include "bench/plan/plan.h"
#include "bench/running/play.h"
#include "bench/tasks/task.h"
#include "bench/truth/column_sweep.h"
#include "bench/truth/moving_truth.h"
#include "bench/truth/truth.h"
#include "kernels/testing/complaint.h"
#include "scenes/effects/effect_scene.h"
#include "scenes/scene.h"
#include "trees/dynamic/update.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

namespace boxwood::bench {
namespace {

std::shared_ptr<const SceneFile> uniform(std::vector<EffectChoice> effects, std::size_t n,
                                         std::size_t n_frames = 6) {
    SceneFile file = effect_scene({.generator = "uniform", .n = n, .seed = 5}, effects);
    file.frames = n_frames;
    return std::make_shared<const SceneFile>(std::move(file));
}

Scene start_of(const std::shared_ptr<const SceneFile>& file) {
    SceneSpec spec{.generator = "uniform", .n = file->n, .seed = file->seed};
    spec.moving = file;
    return make_scene(spec);
}

const Task& moving_pairs() { return *find_task("moving_pairs"); }

/// What all frames are worth, after one pass and after another from a new build.
Judgement judged(const ContenderEntry& entry, const Job& job, Frames& frames, Truth& truth) {
    const auto contender = entry.make(job);
    AnswerList<Pair> answers;
    std::vector<FrameTime> times(frames.size());
    std::uint64_t hashes[2];
    for (std::uint64_t& value : hashes) {
        FramesHash hash;
        contender->build();
        play(*contender, &frames, answers, times, [&](std::size_t index, const Frame& frame) {
            hash.add(moving_pairs().hash(answers));
            truth.note_frame(index, frame, answers, entry);
        });
        value = hash.value();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_GT(times.back().query_ns, 0);
    return truth.judge(answers, entry);
}

TEST(MovingPairs, EveryPolicyAndPeerFollowsEveryEffect) {
    const EffectChoice come{"spawn", {{"often", .2}}, 1}, go{"despawn", {{"often", .2}}, 1};
    const std::vector<std::vector<EffectChoice>> scenes{
        {{"drift", {}, 1}},
        {{"drift", {}, .01}},
        {{"teleport", {}, 1}},
        {come, go},
        {come, go, {"teleport", {}, .5}, {"drift", {}, .5}},
        {{"spawn", {{"absent", 1}, {"often", .3}}, 1}}, // at first there is nobody
        {{"despawn", {{"often", 1}}, 1}},               // and here, from the first frame on
    };
    for (const auto& effects : scenes) {
        const auto file = uniform(effects, 500);
        const Scene scene = start_of(file);
        Frames frames(file);
        const auto truth = moving_pairs().make_truth(scene, 2);
        std::vector<ContenderEntry> all = peers_that_answer("moving_pairs");
        EXPECT_EQ(all.empty(), peers().size() < 2);
        for (const UpdateEntry& update : updates())
            all.push_back(moving_contender({std::string(update.name), {}}));
        for (const ContenderEntry& entry : all)
            for (const unsigned threads : {1u, 2u}) {
                const Job job{&scene, &moving_pairs(), std::string(default_executor(threads)),
                              threads};
                if (entry.unsupported(job))
                    continue;
                const Judgement judgement = judged(entry, job, frames, *truth);
                const results::Check& check = judgement.check;
                EXPECT_EQ(judgement.status, Status::exact)
                    << entry.name << ", " << file->name << ": " << check.witness;
                EXPECT_GT(check.n_got + (effects[0].settings.contains("absent") ||
                                         effects[0].name == "despawn"),
                          0u);
            }
    }
}

TEST(MovingPairs, APolicyThatMayCacheIsInTheClassOfWhatItDid) {
    using Classes = std::optional<std::vector<std::string>>;
    const auto classes_of = [](const char* policy, EffectChoice effect) {
        const auto file = uniform({std::move(effect)}, 3000, 12);
        const Scene scene = start_of(file);
        Frames frames(file);
        const ContenderEntry entry = moving_contender({policy, {}});
        const auto contender = entry.make({&scene, &moving_pairs(), "serial", 1});
        AnswerList<Pair> answers;
        std::vector<FrameTime> times(frames.size());
        contender->build();
        play(*contender, &frames, answers, times, [](std::size_t, const Frame&) {});
        return contender->classes();
    };
    const EffectChoice all_jump{"teleport", {}, 1}, few_creep{"drift", {{"speed", .001}}, .01};
    EXPECT_EQ(classes_of("auto", all_jump), Classes{std::vector<std::string>{}});
    EXPECT_EQ(classes_of("auto", few_creep), Classes{std::vector{cached_pairs_class}});
    EXPECT_EQ(classes_of("cached", all_jump), Classes{std::vector<std::string>{}});
    EXPECT_EQ(classes_of("cached", few_creep), Classes{std::vector{cached_pairs_class}});
    EXPECT_EQ(classes_of("rebuild", few_creep), std::nullopt);
    EXPECT_EQ(moving_contender({"cached", {}}).classes, std::vector{cached_pairs_class});
}

TEST(MovingPairs, APeerThatCannotSaysWhy) {
    const Scene comers = start_of(uniform({{"spawn", {}, 1}}, 10)),
                stayers = start_of(uniform({{"drift", {}, 1}}, 10));
    const std::set<std::string_view> cannot_take_bodies_out{"embree.rtc_collide.refit",
                                                            "fcl.sap.moved", "fcl.interval_tree"};
    for (const ContenderEntry& entry : peers_that_answer("moving_pairs")) {
        if (entry.runs_on == RunsOn::device)
            continue;
        EXPECT_EQ(entry.unsupported({&stayers, &moving_pairs(), "serial", 1}), std::nullopt);
        EXPECT_EQ(entry.unsupported({&comers, &moving_pairs(), "serial", 1}).has_value(),
                  cannot_take_bodies_out.contains(entry.name))
            << entry.name;
    }
}

TEST(MovingPairs, WrongAnswersAreSeen) {
    Frames frames(uniform({{"teleport", {}, 1}}, 200));
    MovingTruth truth(1), without(1, [](Pair p) { return p.a % 2 == 0; });
    std::vector<Pair> answers{{0, 0}};
    results::Check check;
    const Frame& frame = *frames.next();
    EXPECT_FALSE(truth.check(0, frame, answers, check));
    EXPECT_EQ(check.extra, 1u);
    EXPECT_EQ(check.missing, check.n_expected);
    EXPECT_THAT(check.witness, testing::HasSubstr("frame 0: missing"));

    answers = ColumnSweep(frame.boxes, 1).pairs();
    check = {};
    EXPECT_TRUE(truth.check(0, frame, answers, check));
    check = {};
    EXPECT_FALSE(without.check(0, frame, answers, check));
    EXPECT_EQ(check.missing, 0u);
    std::erase_if(answers, [](Pair p) { return p.a % 2 == 0; });
    check = {};
    EXPECT_TRUE(without.check(0, frame, answers, check));
    EXPECT_GT(check.n_got, 0u);

    const std::vector<Pair> pairs{{1, 2}, {3, 4}}, turned{{3, 4}, {1, 2}}, other{{1, 2}, {3, 5}};
    EXPECT_EQ(digest_of(pairs), digest_of(turned));
    EXPECT_NE(digest_of(pairs), digest_of(other));
    FramesHash forth, back;
    for (const auto* list : {&pairs, &other})
        forth.add(digest_of(*list).hash);
    for (const auto* list : {&other, &pairs})
        back.add(digest_of(*list).hash);
    EXPECT_NE(forth.value(), back.value());
}

Plan plan_of(const std::string& keys) {
    return make_plan("[[cells]]\ntask = \"moving_pairs\"\nupdates = \"auto\"\n" + keys, "test.toml",
                     {});
}

std::string error_of(const std::string& keys) {
    return complaint_of<BadInput>([&] { plan_of(keys); });
}

TEST(MovingPairs, ASweepFileLaysEffectsOnGenerators) {
    const Plan plan = plan_of("scene = \"uniform\"\nn = 50\nframes = 3\n"
                              "effects = [\"drift\", {name = \"drift\", share = 0.01}, "
                              "[\"spin\", {name = \"teleport\", often = 0.5}]]\n");
    ASSERT_EQ(plan.cells.size(), 3u);
    EXPECT_EQ(plan.cells[0].name,
              "uniform_drift_frames3/n50-s1/moving_pairs/auto.packed.self_pairs/f32/serial-1");
    EXPECT_THAT(plan.cells[1].name, testing::StartsWith("uniform_drift_share0_01_frames3/"));
    EXPECT_THAT(plan.cells[2].name, testing::StartsWith("uniform_spin_teleport_often0_5_frames3/"));
    EXPECT_EQ(plan.cells[2].scene.moving->frames, 3u);
    EXPECT_EQ(plan.cells[2].scene.moving->n, 50u);

    using testing::HasSubstr;
    EXPECT_THAT(error_of("scene = \"uniform\"\n"), HasSubstr("effects"));
    EXPECT_THAT(error_of("scene = \"uniform\"\neffects = \"drfit\"\n"), HasSubstr("'drift'"));
    EXPECT_THAT(error_of("scene = \"uniform\"\neffects = {name = \"drift\", sped = 1}\n"),
                HasSubstr("speed"));
    EXPECT_THAT(error_of("scene = \"sphere_mesh\"\neffects = \"drift\"\n"),
                HasSubstr("one body of triangles"));
    EXPECT_THAT(error_of("scene = \"uniform\"\nmotion = \"drift\"\n"), HasSubstr("motion"));
}

TEST(MovingPairs, ASweepFileNamesMovingScenes) {
    const Plan plan = plan_of("scene = [\"broadmark_free_fall\", \"warehouse\"]\nn = 100\n");
    ASSERT_EQ(plan.cells.size(), 2u);
    EXPECT_EQ(plan.cells[0].name,
              "broadmark_free_fall/n100-s1/moving_pairs/auto.packed.self_pairs/f32/serial-1");
    const Plan own = plan_of("scene = \"four_link_arm\"\nframes = 5\n");
    EXPECT_THAT(own.cells[0].name, testing::StartsWith("four_link_arm_frames5/n4-s1/"));

    const auto path = std::filesystem::path(testing::TempDir()) / "My-scene.toml";
    const auto write = [&](const char* effect) {
        std::ofstream(path) << "n = 20\n[[bodies]]\ngenerator = \"uniform\"\neffects = \"" << effect
                            << "\"\n";
    };
    write("drift");
    const std::string keys = "scene = \"" + path.string() + "\"\n";
    const Plan mine = plan_of(keys);
    EXPECT_THAT(mine.cells[0].name, testing::StartsWith("my_scene/n20-s1/"));
    write("spin");
    EXPECT_NE(plan_of(keys).sweep_hash, mine.sweep_hash) << "another scene under the same name";

    using testing::HasSubstr;
    EXPECT_THAT(error_of("scene = \"warehuose\"\n"), HasSubstr("'warehouse'"));
    EXPECT_THAT(error_of("scene = \"warehouse\"\neffects = \"drift\"\n"), HasSubstr("has its own"));
    EXPECT_THAT(error_of("scene = \"nowhere.toml\"\n"), HasSubstr("nowhere.toml"));
    EXPECT_THAT(error_of("scene = \"warehouse\"\nbuilders = \"median\"\n"),
                HasSubstr("builders is for the tasks pairs"));
    EXPECT_THAT(error_of("scene = \"warehouse\"\nstages = \"all_stages\"\n"),
                HasSubstr("scene_queries"));
}

TEST(MovingPairs, ASweepFileNamesPolicies) {
    const std::string scene = "scene = \"popcorn\"\n";
    const auto with = [&](const std::string& keys) {
        try {
            return make_plan("[[cells]]\ntask = \"moving_pairs\"\n" + scene + keys, "test.toml", {})
                .cells.at(0)
                .name;
        } catch (const BadInput& error) {
            return std::string(error.what());
        }
    };
    using testing::HasSubstr;
    EXPECT_THAT(with("updates = {name = \"rebuild\", trigger = 1.5}\n"),
                HasSubstr("rebuild_trigger1_5.packed.self_pairs"));
    EXPECT_THAT(with("updates = \"atuo\"\n"), HasSubstr("auto"));
    EXPECT_THAT(with("updates = {name = \"auto\", trigger = 1}\n"), HasSubstr("trigger"));
    EXPECT_THAT(with(""), HasSubstr("updates, peers"));
}

} // namespace
} // namespace boxwood::bench
