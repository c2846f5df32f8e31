#include "bench/plan/config.h"

#include "bench/io/bad_input.h"
#include "bench/plan/plan.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"
#include "kernels/testing/complaint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace boxwood::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Why a sweep file is refused, by the blocks or by their tasks.
std::string complaint(const std::string& text) {
    return complaint_of<BadInput>([&] { make_plan(text, "x.toml", {}); });
}

/// What `of` says of the cells, each answer once.
template <class Of> auto each(const Plan& plan, const Of& of) {
    std::set<std::remove_cvref_t<decltype(of(plan.cells[0]))>> all;
    for (const PlannedCell& cell : plan.cells)
        all.insert(of(cell));
    return all;
}
std::set<std::string> kernels_of(const std::string& text, std::string_view task) {
    std::set<std::string> all;
    for (const PlannedCell& cell : make_plan(text, "x.toml", {}).cells)
        if (cell.task->name() == task && !cell.contender.is_peer)
            all.insert(cell.contender.kernel);
    return all;
}

const std::string block = "[[cells]]\nscene = \"uniform\"\ntask = \"pairs\"\n";

TEST(Config, ReadsWordsAndLists) {
    const std::string text = R"(
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
)";
    const Config config = parse_config(text, "x.toml");
    EXPECT_EQ(config.rounds, 9u);
    EXPECT_EQ(config.min_time_ms, 2.5);
    EXPECT_EQ(config.seed, 7u);
    EXPECT_EQ(config.threads, (std::vector<unsigned>{1, 2}));
    ASSERT_EQ(config.blocks.size(), 1u);
    EXPECT_THAT(config.blocks[0].tasks, ElementsAre(find_task("pairs"), find_task("tree_pairs")));

    const Plan pairs = make_plan(text, "x.toml", {});
    EXPECT_EQ(each(pairs, [](const PlannedCell& c) { return c.scene.generator; }),
              (std::set<std::string>{"uniform", "bars"}));
    EXPECT_EQ(each(pairs, [](const PlannedCell& c) { return c.scene.n; }),
              (std::set<std::size_t>{10, 20}));
    EXPECT_EQ(each(pairs, [](const PlannedCell& c) { return c.scene.overlaps; }),
              std::set<double>{1});
    EXPECT_EQ(each(pairs, [](const PlannedCell& c) { return c.threads; }),
              (std::set<unsigned>{1, 2}));
    EXPECT_TRUE(each(pairs, [](const PlannedCell& c) {
                    return c.contender.builder;
                }).contains("binned_sah_bins16"));

    const Plan rays = make_plan("threads = [1, 2]\n[[cells]]\nscene = \"sphere_mesh\"\n"
                                "task = \"rays_any\"\nrays = \"occlusion\"\nn_rays = 5\n"
                                "threads = 3\nbuilders = \"median\"\n",
                                "x.toml", {});
    EXPECT_EQ(each(rays, [](const PlannedCell& c) { return c.threads; }), std::set<unsigned>{3});
    EXPECT_EQ(each(rays, [](const PlannedCell& c) { return c.scene.n_rays; }),
              std::set<std::size_t>{5});
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

TEST(Config, ContendersOfALibraryThatIsNotHereAreNoError) {
    for (const std::string_view library : absent_peers()) {
        const std::string name = std::string(library) + ".some_setting";
        EXPECT_EQ(complaint(block + "builders = \"median\"\npeers = [\"" + name +
                            "\", \"brute_force\"]\n"),
                  "no error");
        EXPECT_EQ(complaint(block + "builders = \"median\"\npeers = \"" + name + "\"\n"),
                  "no error");
    }
    EXPECT_THAT(complaint(block + "builders = \"median\"\npeers = \"brute_force.a\"\n"),
                HasSubstr("brute_force.a"));
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

TEST(Config, EveryComplaintNamesThePlaceTheFaultAndTheRemedy) {
    struct Row {
        const char* what;
        std::string text;
        std::vector<const char*> says;
    };
    const std::string good = block + "builders = \"median\"\n";
    for (const Row& row : {
             Row{"an old word, before what then lacks",
                 "[[cells]]\nscene = \"uniform\"\nask = \"pairs\"\n",
                 {"x.toml:3:", "unknown key of [[cells]] 'ask'", "did you mean 'task'"}},
             Row{"an unknown key before a bad value of another",
                 "[[cells]]\nscene = \"unifrom\"\ntask = \"pears\"\nlayuots = \"binary\"\n",
                 {"x.toml:4:", "'layuots'", "did you mean 'layouts'"}},
             Row{"one thread where only others are wanted",
                 good + "threads = 2\nexecutors = \"serial\"\n",
                 {"x.toml:6:", "\"serial\" has one thread", "add 1 to threads, or tbb"}},
             Row{"no threads at all",
                 "threads = []\n" + good,
                 {"x.toml:1: threads = [] names nothing", "or leave the key out"}},
             Row{"no threads of a block", good + "threads = []\n", {"x.toml:5: threads = []"}},
             Row{"no scene", "[[cells]]\ntask = \"pairs\"\nscene = []\n", {"x.toml:3: scene = []"}},
             Row{"no task", "[[cells]]\nscene = \"uniform\"\ntask = []\n", {"x.toml:3: task = []"}},
             Row{"an optimizer that is none",
                 block + "builders = \"ploc+reinsertoin\"\n",
                 {"x.toml:4: optimizers", "'reinsertoin'", "did you mean 'reinsertion'"}},
             Row{"a builder that is none, before an optimizer",
                 block + "builders = [\"median\",\n\"plocc+reinsertion\"]\n",
                 {"x.toml:5: builders", "'plocc'", "did you mean 'ploc'"}},
             Row{"half a bin",
                 block + "builders = {name = \"binned_sah\", bins = 1.5}\n",
                 {"x.toml:4:", "'bins' of 'binned_sah' must be a whole number from 2 to",
                  "not 1.5"}},
         })
        for (const char* said : row.says)
            EXPECT_THAT(complaint(row.text), HasSubstr(said)) << row.what;
}

TEST(Config, PoliciesTakeTheirSettings) {
    const std::string moving = "[[cells]]\nscene = \"uniform\"\ntask = \"moving_pairs\"\n"
                               "effects = \"teleport\"\nupdates = ";
    const Plan plan =
        make_plan(moving + "[{name = \"merge\", margin = 2}, {name = \"refine\", share = 0.2}]\n",
                  "x.toml", {});
    EXPECT_EQ(each(plan, [](const PlannedCell& c) { return c.contender.builder; }),
              (std::set<std::string>{"merge_margin2", "refine_share0_2"}));
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
                HasSubstr("needs a task"));
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
                            "stages = \"all_stages\"", "rays = \"random\"", "n_rays = 5"})
        EXPECT_THAT(complaint(block + "builders = \"median\"\n" + key + "\n"),
                    testing::AllOf(HasSubstr("x.toml:5:"), HasSubstr("is for the task")))
            << key;
}

const std::string kernel_block = "[[cells]]\ntask = \"triangle_triangle\"\n";

TEST(Config, BlocksOfKernelTasksNameFamilies) {
    const std::string all = "threads = [1, 2]\n[[cells]]\nscene = [\"slivers\", \"degenerate\"]\n"
                            "task = [\"triangle_triangle\", \"point_segment\"]\nn = 50\n"
                            "scale = [-3, 5]\n";
    const Plan plan = make_plan(all, "x.toml", {});
    const std::set<std::string> families =
        each(plan, [](const PlannedCell& c) { return c.scene.generator; });
    EXPECT_TRUE(families.contains("slivers"));
    EXPECT_GT(families.size(), 1u); // those of the panel, too
    EXPECT_EQ(each(plan, [](const PlannedCell& c) { return c.scene.scale; }),
              (std::set<int>{-3, 5}));
    for (const char* task : {"triangle_triangle", "point_segment"})
        EXPECT_EQ(kernels_of(all, task).size(), find_task(task)->kernels().size());

    const std::string some = "[[cells]]\nscene = \"slivers\"\ntask = \"triangle_triangle\"\n"
                             "k = [1, 2]\nkernels = [\"rational\", \"guigue_devillers_f64\"]\n"
                             "peers = \"all\"\n";
    EXPECT_EQ(each(make_plan(some, "x.toml", {}), [](const PlannedCell& c) { return *c.scene.k; }),
              (std::set<int>{1, 2}));
    EXPECT_EQ(kernels_of(some, "triangle_triangle"),
              (std::set<std::string>{"rational", "guigue_devillers_f64"}));
}

TEST(Config, KernelsHaveTheirDefaults) {
    const std::string text = "[[cells]]\nscene = \"sphere_mesh\"\ntask = [\"rays_any\", "
                             "\"triangle_pairs\"]\nrays = \"random\"\nbuilders = \"median\"\n";
    EXPECT_EQ(kernels_of(text, "rays_any"), std::set<std::string>{"watertight"});
    EXPECT_EQ(kernels_of(text, "triangle_pairs").size(), triangle_kernels().size());
}

TEST(Config, RefusesWhatKernelTasksDoNotTake) {
    EXPECT_THAT(complaint(kernel_block + "scene = \"uniform\"\n"), HasSubstr("uniform"));
    EXPECT_THAT(complaint(kernel_block + "scene = \"slivres\"\n"), HasSubstr("'slivers'"));
    EXPECT_THAT(complaint(kernel_block + "scene = \"ray_grazing\"\n"),
                HasSubstr("no cases for the task triangle_triangle"));
    EXPECT_THAT(complaint(kernel_block + "scene = \"all\"\nbuilders = \"median\"\n"),
                HasSubstr("builders is for the tasks pairs, tree_pairs, "));
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
                HasSubstr("k is for the tasks nearest, triangle_triangle, "));
    EXPECT_THAT(complaint(block + "builders = \"median\"\nkernels = \"watertight\"\n"),
                HasSubstr("kernels is for the tasks rays_closest, "));
    EXPECT_THAT(complaint("[[cells]]\nscene = \"uniform\"\ntask = \"triangle_pairs\"\n"
                          "builders = \"median\"\n"),
                HasSubstr("no triangles to test"));
}

} // namespace
} // namespace boxwood::bench
