#include "trees/layouts/detail/model.h"

#include "trees/builder.h"
#include "trees/testing/box_families.h"
#include "trees/testing/brute_force.h"
#include "trees/testing/pairs_only_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace boxwood {
namespace {

TEST(LayoutModel, ALayoutForPairsAloneAnswersThemAndRefusesTheRestByName) {
    const std::vector<Box> boxes = random_boxes(300, .1f, 3);
    const LayoutEntry entry = layout_entry<PairsOnlyLayout>();
    EXPECT_EQ(entry.name, "pairs_only");
    EXPECT_EQ(entry.precision, "f32");
    EXPECT_EQ(entry.make_of_order, nullptr);
    EXPECT_THAT(entry.queries, testing::ElementsAre(Query::self_pairs));

    const Tree tree = make_builder("median")(boxes, serial());
    const auto layout = entry.make(tree, serial()), other = entry.make(tree, serial());
    EXPECT_GT(layout->bytes(), boxes.size() * sizeof(Box));
    std::vector<Pair> pairs;
    AppendPairs sink(pairs);
    const Work work = layout->self_pairs_counted(sink);
    std::ranges::sort(pairs);
    EXPECT_EQ(pairs, brute_force(boxes));
    EXPECT_EQ(work.answers, pairs.size());
    EXPECT_EQ(work.box_tests, boxes.size() * (boxes.size() - 1) / 2);

    const TriangleMesh mesh;
    const TriangleBlocks triangles;
    const std::span<const Vec3<float>> no_points;
    const std::pair<Query, std::function<void()>> others[]{
        {Query::tree_pairs, [&] { layout->tree_pairs(*other, serial(), sink); }},
        {Query::rays, [&] { layout->triangles(mesh); }},
        {Query::rays, [&] { layout->rays({}, RayQuery::any, "", triangles, serial(), {}); }},
        {Query::rays, [&] { layout->single_ray_functions("watertight"); }},
        {Query::points, [&] { layout->points(no_points, serial(), sink); }},
        {Query::regions, [&] { layout->regions(std::span<const Box>(), serial(), sink); }},
        {Query::nearest, [&] { layout->nearest(no_points, 1, serial(), {}); }},
        {Query::closest_points, [&] { layout->closest_points(no_points, mesh, serial(), {}); }}};
    for (const auto& [query, run] : others) {
        EXPECT_FALSE(layout->answers(query));
        EXPECT_FALSE(entry.answers(query));
        try {
            run();
            FAIL() << to_string(query) << " was answered";
        } catch (const std::invalid_argument& error) {
            EXPECT_EQ(error.what(),
                      "the layout 'pairs_only' does not answer " + std::string(to_string(query)));
        }
    }
}

TEST(LayoutModel, EveryRegisteredLayoutSaysWhatItAnswers) {
    const Tree tree = make_builder("median")(random_boxes(20, .1f, 4), serial());
    for (const LayoutEntry& entry : layouts()) {
        EXPECT_FALSE(entry.queries.empty()) << entry.name;
        const auto layout = entry.make(tree, serial());
        for (const Query query : {Query::self_pairs, Query::tree_pairs, Query::rays, Query::points,
                                  Query::regions, Query::nearest, Query::closest_points})
            EXPECT_EQ(layout->answers(query), entry.answers(query)) << entry.name;
    }
}

} // namespace
} // namespace boxwood
