#include "bench/plan/plan.h"

#include "bench/io/bad_input.h"
#include "bench/io/csv.h"
#include "bench/plan/families.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string config = R"(
rounds = 9
[[cells]]
scene = "uniform"
n = [10, 20]
task = "pairs"
threads = [1, 2]
builders = ["median", "binned_sah"]
layouts = ["binary", "wide8"]
peers = "brute_force"
)";

Plan plan_of(const std::string& text, const Overrides& overrides = {}) {
    return make_plan(text, "x.toml", overrides);
}

std::set<std::string> names_of(const Plan& plan) {
    std::set<std::string> names;
    for (const PlannedCell& cell : plan.cells)
        names.insert(cell.name);
    return names;
}

TEST(Plan, IsTheCrossProduct) {
    const Plan plan = plan_of(config);
    EXPECT_EQ(plan.cells.size(), 2u * 2 * (4 + 1));
    EXPECT_EQ(names_of(plan).size(), plan.cells.size());
    for (const PlannedCell& cell : plan.cells)
        EXPECT_EQ(cell.name,
                  fmt::format("uniform/n{}-s1/pairs/{}/f32/{}", cell.scene.n, cell.contender.name,
                              cell.threads == 1 ? "serial-1" : "tbb-2"));
    EXPECT_TRUE(
        names_of(plan).contains("uniform/n20-s1/pairs/binned_sah.wide8.self_pairs/f32/tbb-2"));
}

TEST(Plan, CellsMayBeHeldToInstructionSets) {
    const std::size_t usual = plan_of(config).cells.size();
    const Plan plan = plan_of(config + "isa = [\"baseline\", \"native\"]\n");
    EXPECT_EQ(plan.cells.size(), 2 * usual);
    for (const PlannedCell& cell : plan.cells)
        EXPECT_EQ(cell.name.ends_with("/baseline"), cell.isa == "baseline") << cell.name;
    EXPECT_NE(plan.sweep_hash, plan_of(config).sweep_hash);
    EXPECT_THROW(plan_of(config + "isa = \"avx3\"\n"), BadInput);
}

TEST(Plan, InputsArePartOfWhatIsMeasured) {
    EXPECT_EQ(plan_of(config).inputs, 1u);
    EXPECT_EQ(plan_of("inputs = 3\n" + config).inputs, 3u);
    EXPECT_NE(plan_of("inputs = 3\n" + config).sweep_hash, plan_of(config).sweep_hash);
    EXPECT_EQ(plan_of("inputs = 1\n" + config).sweep_hash, plan_of(config).sweep_hash);
    EXPECT_THROW(plan_of("inputs = 0\n" + config), BadInput);
}

TEST(Plan, CellsMayBeTimedColdToo) {
    EXPECT_THROW(plan_of(config + "cold_build = 1\n"), BadInput);
    const Plan usual = plan_of(config), plan = plan_of(config + "cold_build = true\n");
    ASSERT_EQ(plan.cells.size(), usual.cells.size());
    for (std::size_t i = 0; i < plan.cells.size(); ++i) {
        EXPECT_EQ(plan.cells[i].name, usual.cells[i].name);
        EXPECT_TRUE(plan.cells[i].cold_build && !usual.cells[i].cold_build);
    }
    EXPECT_NE(plan.sweep_hash, usual.sweep_hash);
    const std::string block = config.substr(config.find("[[cells]]"));
    EXPECT_EQ(plan_of(config + block + "cold_build = true\n").sweep_hash, plan.sweep_hash);
}

TEST(Plan, QueriesMayBeTimedWithColdCachesToo) {
    const std::string collide = "[[cells]]\nscene = \"sphere_mesh\"\ntask = \"collide\"\n"
                                "poses = \"near\"\nbuilders = \"median\"\n";
    EXPECT_THROW(plan_of(collide + "cold_caches = 1\n"), BadInput);
    EXPECT_THROW(plan_of(config + "cold_caches = true\n"), BadInput); // no task that takes it
    const Plan usual = plan_of(collide), plan = plan_of(collide + "cold_caches = true\n");
    ASSERT_EQ(names_of(plan), names_of(usual));
    EXPECT_TRUE(plan.cells.at(0).cold_caches && !usual.cells.at(0).cold_caches);
    EXPECT_NE(plan.sweep_hash, usual.sweep_hash);
    EXPECT_EQ(plan_of(collide + collide + "cold_caches = true\n").sweep_hash, plan.sweep_hash);
}

TEST(Plan, EqualCellsCollapse) {
    const std::string block = config.substr(config.find("[[cells]]"));
    EXPECT_EQ(names_of(plan_of(config + block)), names_of(plan_of(config)));
    EXPECT_EQ(plan_of(config + block).sweep_hash, plan_of(config).sweep_hash);
}

TEST(Plan, RefusesOneNameForTwoScenes) {
    const std::string rays = "[[cells]]\nscene = \"sphere_mesh\"\ntask = \"rays_any\"\n"
                             "rays = \"random\"\nbuilders = \"median\"\n";
    EXPECT_THAT([&] { plan_of(rays + "n_rays = 10\n" + rays + "n_rays = 20\n"); },
                testing::ThrowsMessage<BadInput>(
                    testing::AllOf(HasSubstr("x.toml:7"), HasSubstr("n_rays 10"))));
    const std::string closest = "[[cells]]\nscene = \"sphere_mesh\"\ntask = \"rays_closest\"\n"
                                "rays = \"random\"\nbuilders = \"median\"\n";
    EXPECT_THAT([&] { plan_of(rays + "n_rays = 10\n" + closest + "n_rays = 20\n"); },
                testing::ThrowsMessage<BadInput>(
                    testing::AllOf(HasSubstr("the scene sphere_mesh_random/n1000-s1 stands twice"),
                                   HasSubstr("n_rays 10 and 20"))));
}

TEST(Plan, SerialStaysOnOneThread) {
    const Plan plan = plan_of("[[cells]]\nscene = \"uniform\"\nn = 10\ntask = \"pairs\"\n"
                              "threads = [1, 2]\nexecutors = [\"serial\", \"tbb\"]\n"
                              "builders = \"median\"\n");
    ASSERT_EQ(plan.cells.size(), 3u);
    for (const PlannedCell& cell : plan.cells)
        EXPECT_TRUE(cell.executor == "tbb" || cell.threads == 1);
}

TEST(Plan, PeersThatCannotAnswerAreLeftOutUnlessNamed) {
    const std::string rays = "[[cells]]\nscene = \"sphere_mesh\"\nn = 20\ntask = \"rays_any\"\n"
                             "rays = \"random\"\nbuilders = \"median\"\npeers = ";
    for (const PlannedCell& cell : plan_of(rays + "\"all\"\n").cells)
        EXPECT_NE(cell.contender.library, "bullet");
    // One that is named in full is planned, so that the results say that it cannot.
    const bool has_bullet = std::ranges::find(peers(), "bullet", &Peer::name) != peers().end();
    EXPECT_EQ(plan_of(rays + "\"bullet\"\n").cells.size(), 1u);
    if (has_bullet) {
        EXPECT_EQ(plan_of(rays + "\"bullet.dbvt\"\n").cells.size(), 2u);
    }
}

TEST(Plan, OverridesReplace) {
    Overrides overrides;
    overrides.rounds = 30;
    overrides.threads = {1};
    overrides.seed = 5;
    overrides.only = "n20.*wide8";
    const Plan plan = plan_of(config, overrides);
    EXPECT_EQ(plan.rounds, 30u);
    EXPECT_EQ(names_of(plan),
              (std::set<std::string>{"uniform/n20-s5/pairs/median.wide8.self_pairs/f32/serial-1",
                                     "uniform/n20-s5/pairs/binned_sah.wide8.self_pairs/f32/"
                                     "serial-1"}));
}

TEST(Plan, HashIsOfWhatIsMeasured) {
    const std::string hash = plan_of(config).sweep_hash;
    EXPECT_EQ(hash.size(), 32u);
    EXPECT_EQ(plan_of("# a comment\n" + config).sweep_hash, hash);
    Overrides rounds;
    rounds.rounds = 100; // more rounds extend a sweep
    EXPECT_EQ(plan_of(config, rounds).sweep_hash, hash);
    Overrides seed;
    seed.seed = 2;
    EXPECT_NE(plan_of(config, seed).sweep_hash, hash);
    Overrides only;
    only.only = "wide8";
    EXPECT_NE(plan_of(config, only).sweep_hash, hash);
    EXPECT_NE(plan_of("min_time_ms = 1\n" + config).sweep_hash, hash);
    EXPECT_NE(sweep_hash_of(plan_of(config), 1), hash);
}

TEST(Plan, ABlockMayHaveFewerRounds) {
    const Plan all = plan_of(config), few = plan_of(config + "rounds = 3\n");
    EXPECT_EQ(names_of(all), names_of(few));
    EXPECT_NE(all.sweep_hash, few.sweep_hash);
    EXPECT_EQ(few.rounds, 9u);
    for (const PlannedCell& cell : few.cells) {
        EXPECT_TRUE(cell.is_in(2));
        EXPECT_FALSE(cell.is_in(3));
    }
    EXPECT_TRUE(all.cells[0].is_in(100));
    // A cell of two blocks has the rounds of the one with more.
    const std::string block = config.substr(config.find("[[cells]]"));
    const Plan more = plan_of(config + "rounds = 3\n" + block + "rounds = 5\n");
    EXPECT_EQ(more.cells[0].rounds, 5u);
    EXPECT_FALSE(plan_of(config + "rounds = 3\n" + block).cells[0].rounds);
}

TEST(Plan, MeshBlocksNeedAMesh) {
    const std::string mesh =
        "[[cells]]\nscene = \"mesh\"\ntask = \"pairs\"\nbuilders = \"median\"\n";
    EXPECT_EQ(names_of(plan_of(config + mesh)), names_of(plan_of(config)));
    EXPECT_THROW(plan_of(mesh), BadInput);
    Overrides overrides;
    overrides.meshes = {"there/is/no/such.obj"};
    EXPECT_THROW(plan_of(config + mesh, overrides), BadInput);
    EXPECT_THROW(plan_of(config, overrides), BadInput); // nothing would use it
}

TEST(Plan, MeshCellsAreNamedBySizeAndHashedByContent) {
    const auto file = std::filesystem::temp_directory_path() / "boxwood_plan_test.obj";
    Overrides overrides;
    overrides.meshes = {file};
    const std::string mesh = "[[cells]]\nscene = \"mesh\"\ntask = \"pairs\"\n"
                             "builders = \"median\"\n";
    const auto plan_with = [&](const char* last) {
        std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n" << last;
        return plan_of(mesh, overrides);
    };
    const Plan two = plan_with(""), three = plan_with("f 1 3 4\n"), moved = plan_with("# x\n");
    std::filesystem::remove(file);
    ASSERT_EQ(two.cells.size(), 1u);
    EXPECT_THAT(two.cells[0].name, StartsWith("mesh_boxwood_plan_test/n2-s1/"));
    EXPECT_THAT(three.cells[0].name, StartsWith("mesh_boxwood_plan_test/n3-s1/"));
    EXPECT_NE(two.sweep_hash, three.sweep_hash);
    EXPECT_EQ(names_of(two), names_of(moved));
    EXPECT_NE(two.sweep_hash, moved.sweep_hash); // other bytes
}

TEST(Plan, FilesOfTheUsersAreAsManyScenes) {
    const auto folder = std::filesystem::temp_directory_path();
    const auto first = folder / "boxwood_first.csv", second = folder / "boxwood_second.csv";
    std::ofstream(first) << "# two\n0,0,0,1,1,1\n 1, 1,1 ,2,2,2\r\n";
    std::ofstream(second) << "0,0,0,1,1,1e2\n";
    const std::string boxes = "[[cells]]\nscene = \"boxes\"\ntask = \"pairs\"\n"
                              "builders = \"median\"\n";
    Overrides overrides;
    overrides.boxes = {first, second};
    const Plan plan = plan_of(boxes, overrides);
    ASSERT_EQ(plan.cells.size(), 2u);
    EXPECT_THAT(plan.cells[0].name, StartsWith("boxes_boxwood_first/n2-s1/pairs/"));
    EXPECT_THAT(plan.cells[1].name, StartsWith("boxes_boxwood_second/n1-s1/pairs/"));
    EXPECT_EQ(overrides.arguments(),
              (std::vector<std::string>{"--boxes", first.string(), "--boxes", second.string()}));
    EXPECT_EQ(make_scene(plan.cells[0].scene).boxes[1].max[2], 2);
    for (const char* bad : {"1,2,3,4,5\n", "1,2,3,4,5,6,7\n", "1,1,1,0,2,2\n", "1,1,nan,2,2,2\n",
                            "1,1,1,2,2,x\n", "1,1,1,2,2,1e40\n", "# none\n", ""}) {
        std::ofstream(second) << bad;
        EXPECT_THROW(plan_of(boxes, overrides), BadInput) << bad;
    }
    std::filesystem::remove(second);
    EXPECT_THROW(plan_of(boxes, overrides), BadInput);
    std::filesystem::remove(first);
}

TEST(Plan, RaysAndMotionsOfTheUsersAreScenesToo) {
    const auto folder = std::filesystem::temp_directory_path();
    const auto mesh = folder / "boxwood_own.obj", rays = folder / "boxwood_own_rays.csv",
               motion = folder / "boxwood_own_motion.csv";
    std::ofstream(mesh) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(rays) << "0.2,0.2,1,0,0,-1\n0.2,0.2,1,0,0,1\n";
    std::ofstream(motion) << "0,0,0,0,0,1,1,1\n0,1,2,2,2,3,3,3\n1,1,1,1,1,3,3,3\n";
    const std::string blocks =
        "[[cells]]\nscene = \"mesh\"\ntask = \"rays_closest\"\nrays = [\"primary\", \"random\"]\n"
        "builders = \"median\"\n"
        "[[cells]]\nscene = \"motion\"\ntask = \"moving_pairs\"\nupdates = \"rebuild\"\n";
    Overrides overrides;
    overrides.rays = {rays};
    EXPECT_THROW(plan_of(blocks, overrides), BadInput); // at what?
    overrides.meshes = {mesh};
    overrides.motions = {motion};
    const Plan plan = plan_of(blocks, overrides);
    ASSERT_EQ(plan.cells.size(), 2u);
    EXPECT_THAT(plan.cells[0].name,
                StartsWith("mesh_boxwood_own_rays_boxwood_own_rays/n1-s1/rays_closest/"));
    EXPECT_EQ(make_scene(plan.cells[0].scene).rays.size(), 2u);
    EXPECT_THAT(plan.cells[1].name, StartsWith("motion_boxwood_own_motion/n2-s1/moving_pairs/"));
    EXPECT_EQ(plan.cells[1].scene.moving->frames, 1u);
    EXPECT_EQ(make_scene(plan.cells[1].scene).boxes.size(), 2u);
    overrides.threads = {1, 2};
    overrides.only = "a b";
    overrides.seed = 7;
    EXPECT_EQ(overrides.arguments(),
              (std::vector<std::string>{"--threads", "1,2", "--only", "a b", "--seed", "7",
                                        "--mesh", mesh.string(), "--motion", motion.string(),
                                        "--rays", rays.string()}));
    overrides.only.clear();
    const std::string played = "[[cells]]\nscene = \"motion\"\ntask = \"scene_queries\"\n"
                               "stages = \"required\"\n";
    EXPECT_THROW(plan_of(blocks + played, overrides), BadInput);
    std::ofstream(motion) << "0,0,0,0,0,1,1,1\n";
    EXPECT_THROW(plan_of(blocks, overrides), BadInput);
    for (const auto& file : {mesh, rays, motion})
        std::filesystem::remove(file);
}

TEST(Plan, ErrorsThatMakeNoSenseAreRefusedAtTheirLine) {
    const auto plan_with = [](const std::string& errors, const std::string& of) {
        return plan_of("[[cells]]\nscene = \"sphere_mesh\"\nn = 100\ntask = \"distance\"\n" + of +
                       "\nrelative_errors = " + errors + "\n");
    };
    const std::string ours = "builders = \"lbvh\"", peers = "peers = \"brute_force\"";
    EXPECT_EQ(plan_with("[0, 0.1, 1e-6, 0.99]", ours).cells.size(), 4u * 4); // kinds of poses
    for (const char* errors : {"1e-7", "-0.1", "1", "nan", "\"0.1\"", "[0.1, 1.0]"})
        for (const std::string& of : {ours, peers}) {
            try {
                plan_with(errors, of);
                ADD_FAILURE() << errors;
            } catch (const BadInput& error) {
                EXPECT_THAT(error.what(), StartsWith("x.toml:6: ")) << errors;
                EXPECT_THAT(error.what(), HasSubstr("relative_errors")) << errors;
            }
        }
}

TEST(Plan, DistancesAreCertifiedUnlessPlainOnesAreNamed) {
    const auto names_with = [](const std::string& certificates) {
        std::set<std::string> names;
        for (const PlannedCell& cell :
             plan_of("[[cells]]\nscene = \"sphere_mesh\"\nn = 100\ntask = \"distance\"\n"
                     "poses = \"near\"\nbuilders = \"lbvh\"\nstarts = [\"cold\", \"warm\"]\n" +
                     certificates)
                 .cells)
            names.insert(cell.contender.name);
        return names;
    };
    const std::set<std::string> certified{"lbvh.obb.distance", "lbvh.obb.distance.warm"};
    EXPECT_EQ(names_with(""), certified);
    EXPECT_EQ(names_with("certificates = \"certified\"\n"), certified);
    EXPECT_EQ(names_with("certificates = [\"plain\"]\n"),
              (std::set<std::string>{"lbvh.obb.distance.plain", "lbvh.obb.distance.warm.plain"}));
    EXPECT_THROW(names_with("certificates = \"sworn\"\n"), BadInput);
}

TEST(Plan, RefusesAPatternThatIsNoneOrLeavesNothing) {
    Overrides overrides;
    overrides.only = "(";
    EXPECT_THROW(plan_of(config, overrides), BadInput);
    overrides.only = "no such cell";
    EXPECT_THROW(plan_of(config, overrides), BadInput);
}

TEST(Plan, ShippedSweepFilesAreGood) {
    for (const char* name :
         {"quick", "default", "pairs", "builders", "rays", "dynamic", "effects", "queries",
          "accuracy", "counts", "narrow", "shapes", "gpu", "policies", "instruction_sets"}) {
        const std::string file = std::string("bench/configs/") + name + ".toml";
        const Plan plan = make_plan(read_text(file), file, {});
        EXPECT_GE(plan.rounds, 9u);
        EXPECT_FALSE(plan.cells.empty());
    }
}

TEST(Plan, ShippedSweepFilesForTheUsersOwnAreGood) {
    Overrides overrides;
    overrides.robots = {"scenes/examples/arm.urdf"};
    const auto n_cells = [&](const std::string& file) {
        return make_plan(read_text(file), file, overrides).cells.size();
    };
    EXPECT_GE(n_cells("bench/configs/robots.toml"), 2u);
    EXPECT_EQ(n_cells("bench/configs/poses.toml"), 2u);
    overrides.meshes = {"scenes/examples/ball.obj"};
    EXPECT_EQ(n_cells("bench/configs/poses.toml"), 14u);
}

TEST(Order, IsASeededPermutationOfAllCells) {
    const auto first = shuffled_order(100, order_seed_of(1, 0));
    EXPECT_EQ(first, shuffled_order(100, order_seed_of(1, 0)));
    auto sorted = first;
    std::ranges::sort(sorted);
    for (std::size_t i = 0; i < sorted.size(); ++i)
        EXPECT_EQ(sorted[i], i);
    EXPECT_NE(first, sorted);
    EXPECT_NE(first, shuffled_order(100, order_seed_of(1, 1)));
    EXPECT_NE(first, shuffled_order(100, order_seed_of(2, 0)));
    EXPECT_TRUE(shuffled_order(0, 1).empty());
}

TEST(Plan, KernelCellsRunOnOneThreadAndSayKAndScale) {
    const Plan plan = plan_of(R"(
threads = [1, 2]
[[cells]]
scene = "slivers"
task = "triangle_triangle"
n = 50
k = [3, 5]
scale = [0, -4]
kernels = "rational"
)");
    EXPECT_EQ(names_of(plan),
              (std::set<std::string>{
                  "slivers/n50-s1/triangle_triangle/rational/f64/serial-1",
                  "slivers_k5/n50-s1/triangle_triangle/rational/f64/serial-1",
                  "slivers_scalem4/n50-s1/triangle_triangle/rational/f64/serial-1",
                  "slivers_k5_scalem4/n50-s1/triangle_triangle/rational/f64/serial-1"}));
}

TEST(Plan, GroupsOfFamiliesSkipAScaleOutOfRange) {
    const std::string text = "[[cells]]\nscene = \"all\"\ntask = \"triangle_triangle\"\n"
                             "kernels = \"rational\"\nscale = ";
    const std::size_t all = plan_of(text + "0\n").cells.size();
    EXPECT_EQ(all, families_of("all", *find_task("triangle_triangle")).size());
    EXPECT_LT(plan_of(text + "1000\n").cells.size(), all);
    EXPECT_THROW(plan_of("[[cells]]\nscene = \"slivers\"\ntask = \"triangle_triangle\"\n"
                         "scale = 1000\n"),
                 BadInput);
}

} // namespace
} // namespace boxwood::bench
