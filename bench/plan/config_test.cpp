#include "bench/plan/config.h"

#include "bench/io/bad_input.h"
#include "bench/tasks/kernels/kernels.h"
#include "kernels/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;

std::string complaint(const std::string& text) {
    try {
        parse_config(text, "x.toml");
    } catch (const BadInput& error) {
        return error.what();
    }
    return "(accepted)";
}

const std::string block = "[[cells]]\nscene = \"uniform\"\ntask = \"pairs\"\n";

TEST(Config, ReadsWordsAndLists) {
    const Config config = parse_config(R"(
rounds = 9
min_time_ms = 2.5
seed = 7
threads = [1, 2]

[[cells]]
scene = ["uniform", "bars"]
n = [10, 20]
overlaps = 1
task = ["pairs", "tree_pairs"]
builders = ["median", {name = "binned_sah", bins = 16}]
layouts = "binary"
peers = "all"

[[cells]]
scene = "sphere_mesh"
task = "rays_any"
rays = "occlusion"
n_rays = 5
threads = 3
builders = "median"
)",
                                       "x.toml");
    EXPECT_EQ(config.rounds, 9u);
    EXPECT_EQ(config.min_time_ms, 2.5);
    EXPECT_EQ(config.seed, 7u);
    ASSERT_EQ(config.blocks.size(), 2u);
    const Block& pairs = config.blocks[0];
    EXPECT_EQ(pairs.scenes, (std::vector<std::string>{"uniform", "bars"}));
    EXPECT_EQ(pairs.n, (std::vector<std::size_t>{10, 20}));
    EXPECT_EQ(pairs.overlaps, std::vector<double>{1});
    EXPECT_EQ(pairs.queries, (std::vector<Ask>{Ask::pairs, Ask::tree_pairs}));
    EXPECT_EQ(pairs.builders[1].settings.at("bins"), SettingValue(16));
    EXPECT_EQ(pairs.threads, (std::vector<unsigned>{1, 2}));
    EXPECT_EQ(config.blocks[1].threads, std::vector<unsigned>{3});
    EXPECT_EQ(config.blocks[1].n_rays, 5u);
}

TEST(Config, SaysWhereAMisspeltWordStandsAndSuggests) {
    EXPECT_THAT(complaint("rounds = 9\n" + block + "buildrs = \"median\"\n"),
                testing::AllOf(HasSubstr("x.toml:5:"), HasSubstr("buildrs"),
                               HasSubstr("did you mean 'builders'")));
    EXPECT_THAT(complaint("rouns = 9\n" + block),
                testing::AllOf(HasSubstr("x.toml:1:"), HasSubstr("'rounds'")));
    EXPECT_THAT(complaint("[[cells]]\nscene = \"unifrom\"\ntask = \"pairs\"\n"),
                testing::AllOf(HasSubstr("x.toml:2:"), HasSubstr("'uniform'")));
    EXPECT_THAT(complaint(block + "builders = [\"median\", \"binned_sha\"]\n"),
                testing::AllOf(HasSubstr("x.toml:4:"), HasSubstr("'binned_sah'")));
    EXPECT_THAT(complaint(block + "builders = [{name = \"binned_sah\", bin = 16}]\n"),
                testing::AllOf(HasSubstr("x.toml:4:"), HasSubstr("bins")));
    EXPECT_THAT(complaint(block + "peers = \"brute_forc\"\n"), HasSubstr("'brute_force'"));
}

TEST(Config, RefusesNumbersOutOfRangeAndOfTheWrongKind) {
    EXPECT_THAT(complaint(block + "builders = \"median\"\nrounds = 0\n"), HasSubstr("rounds = 0"));
    EXPECT_THAT(complaint("rounds = 0\n" + block), HasSubstr("x.toml:1: rounds = 0"));
    EXPECT_THAT(complaint("rounds = 2.5\n" + block), HasSubstr("whole number"));
    EXPECT_THAT(complaint("min_time_ms = nan\n" + block), HasSubstr("out of range"));
    EXPECT_THAT(complaint(block + "builders = \"median\"\nn = [10, -1]\n"),
                HasSubstr("x.toml:5: n = -1"));
    EXPECT_THAT(complaint(block + "threads = \"al\"\n"), HasSubstr("'all'"));
    EXPECT_THAT(complaint(block + "builders = [{name = \"binned_sah\", bins = 1e9}]\n"),
                HasSubstr("x.toml:4:"));
}

TEST(Config, PoliciesTakeTheirSettings) {
    const std::string moving = "[[cells]]\nscene = \"uniform\"\ntask = \"moving_pairs\"\n"
                               "effects = \"teleport\"\nupdates = ";
    const Config config = parse_config(
        moving + "[{name = \"merge\", margin = 2}, {name = \"refine\", share = 0.2}]\n", "x.toml");
    ASSERT_EQ(config.blocks[0].updates.size(), 2u);
    EXPECT_EQ(config.blocks[0].updates[0].settings, (Settings{{"margin", 2}}));
    EXPECT_EQ(config.blocks[0].updates[1].settings, (Settings{{"share", 0.2}}));
    EXPECT_THAT(complaint(moving + "{name = \"refine\", margin = 2}\n"), HasSubstr("margin"));
    EXPECT_THAT(complaint(moving + "{margin = 2}\n"), HasSubstr("an update is a name"));
}

TEST(Config, RefusesBlocksThatMeanNothing) {
    EXPECT_THAT(complaint(""), HasSubstr("no [[cells]] block"));
    EXPECT_THAT(complaint("cells = 3\n"), HasSubstr("no [[cells]] block"));
    EXPECT_THAT(complaint("rounds = [\n"), HasSubstr("x.toml:"));
    EXPECT_THAT(complaint("[[cells]]\ntask = \"pairs\"\nbuilders = \"median\"\n"),
                HasSubstr("needs a scene"));
    EXPECT_THAT(complaint("[[cells]]\nscene = \"uniform\"\nbuilders = \"median\"\n"),
                HasSubstr("needs an ask"));
    EXPECT_THAT(complaint(block), HasSubstr("needs builders, peers, or both"));
    EXPECT_THAT(complaint("[[cells]]\nscene = \"sphere_mesh\"\ntask = \"rays_any\"\n"
                          "builders = \"median\"\n"),
                HasSubstr("needs rays"));
    EXPECT_THAT(complaint("[[cells]]\nscene = \"uniform\"\ntask = \"rays_any\"\n"
                          "rays = \"random\"\nbuilders = \"median\"\n"),
                HasSubstr("no triangles"));
    EXPECT_THAT(complaint("[[cells]]\nscene = \"mesh\"\nn = 5\ntask = \"pairs\"\n"),
                HasSubstr("x.toml:3:"));
    for (const char* key : {"effects = \"teleport\"", "frames = 3", "updates = \"auto\"",
                            "stages = \"everything\"", "rays = \"random\"", "n_rays = 5"})
        EXPECT_THAT(complaint(block + "builders = \"median\"\n" + key + "\n"),
                    testing::AllOf(HasSubstr("x.toml:5:"), HasSubstr("is for the ask")))
            << key;
}

const std::string kernel_block = "[[cells]]\ntask = \"triangle_triangle\"\n";

TEST(Config, BlocksOfKernelAsksNameFamilies) {
    const Config config = parse_config(R"(
threads = [1, 2]
[[cells]]
scene = ["slivers", "degenerate"]
task = ["triangle_triangle", "point_segment"]
n = 50
scale = [-3, 5]

[[cells]]
scene = "slivers"
task = "triangle_triangle"
k = [1, 2]
kernels = ["rational", "guigue_devillers_f64"]
peers = "all"
)",
                                       "x.toml");
    ASSERT_EQ(config.blocks.size(), 2u);
    const Block& all = config.blocks[0];
    EXPECT_EQ(all.scenes, (std::vector<std::string>{"slivers", "degenerate"}));
    EXPECT_EQ(all.scales, (std::vector<int>{-3, 5}));
    EXPECT_EQ(kernels_of(all, Ask::triangle_triangle).size(), rungs(Ask::triangle_triangle).size());
    EXPECT_EQ(kernels_of(all, Ask::point_segment).size(), rungs(Ask::point_segment).size());
    const Block& some = config.blocks[1];
    EXPECT_EQ(some.k, (std::vector<int>{1, 2}));
    EXPECT_EQ(kernels_of(some, Ask::triangle_triangle),
              (std::vector<std::string>{"rational", "guigue_devillers_f64"}));
}

TEST(Config, KernelsHaveTheirDefaults) {
    const Config config =
        parse_config("[[cells]]\nscene = \"sphere_mesh\"\ntask = [\"rays_any\", "
                     "\"triangle_pairs\"]\nrays = \"random\"\nbuilders = \"median\"\n",
                     "x.toml");
    EXPECT_EQ(kernels_of(config.blocks[0], Ask::rays_any), std::vector<std::string>{"watertight"});
    EXPECT_EQ(kernels_of(config.blocks[0], Ask::triangle_pairs).size(), triangle_kernels().size());
}

TEST(Config, RefusesWhatKernelAsksDoNotTake) {
    EXPECT_THAT(complaint(kernel_block + "scene = \"uniform\"\n"), HasSubstr("uniform"));
    EXPECT_THAT(complaint(kernel_block + "scene = \"slivres\"\n"), HasSubstr("'slivers'"));
    EXPECT_THAT(complaint(kernel_block + "scene = \"ray_grazing\"\n"),
                HasSubstr("no cases for the ask triangle_triangle"));
    EXPECT_THAT(complaint(kernel_block + "scene = \"all\"\nbuilders = \"median\"\n"),
                HasSubstr("builders is for the asks of trees"));
    EXPECT_THAT(complaint(kernel_block + "scene = \"all\"\nk = 3\n"),
                HasSubstr("name the families"));
    EXPECT_THAT(complaint(kernel_block + "scene = \"slivers\"\nkernels = \"watertight\"\n"),
                HasSubstr("watertight"));
    EXPECT_THAT(complaint("[[cells]]\ntask = \"vertex_face\"\nscene = "
                          "\"ccd_queries_vertex_face\"\n"),
                HasSubstr("--ccd"));
    EXPECT_THAT(complaint("[[cells]]\ntask = [\"pairs\", \"obb_obb\"]\nscene = \"uniform\"\n"),
                HasSubstr("blocks of their own"));
    EXPECT_THAT(complaint(block + "builders = \"median\"\nk = 1\n"),
                HasSubstr("k is for the asks of kernels"));
    EXPECT_THAT(complaint(block + "builders = \"median\"\nkernels = \"watertight\"\n"),
                HasSubstr("takes no kernels"));
    EXPECT_THAT(complaint("[[cells]]\nscene = \"uniform\"\ntask = \"triangle_pairs\"\n"
                          "builders = \"median\"\n"),
                HasSubstr("no triangles to test"));
}

} // namespace
} // namespace boxwood::bench
