#include "kernels/settings.h"
#include "trees/dynamic/detail/policy.h"
#include "trees/layouts/detail/model.h"
#include "trees/queries/filters.h"
#include "trees/testing/pairs_only_layout.h"
#include "trees/trees.h"

#include <gtest/gtest.h>

#include <set>

namespace boxwood {
namespace {

// Builders, and what some of them do beyond boxes.
static_assert(Builder<MedianBuilder> && Builder<BinnedSahBuilder> && Builder<SweepSahBuilder>);
static_assert(Builder<BonsaiBuilder> && Builder<PlocBuilder> && Builder<IncrementalBuilder>);
static_assert(OrderBuilder<HilbertBuilder> && OrderBuilder<LbvhBuilder>);
static_assert(!OrderBuilder<MedianBuilder>);
static_assert(MeshBuilder<SpatialSahBuilder> && !MeshBuilder<BinnedSahBuilder>);

// Layouts, and what some of them are made of beyond a tree.
static_assert(Layout<BinaryLayout> && Layout<BinaryLayoutF64>);
static_assert(Layout<Wide8Layout> && Layout<Wide8LayoutF64> && Layout<Quantised8Layout>);
static_assert(WideTree<Wide4Layout> && WideTree<Wide16Layout> && WideTree<Quantised8Layout>);
static_assert(WideTree<PackedLayout> && !WideTree<BinaryLayout>);
static_assert(OrderLayout<PackedLayout> && !OrderLayout<Wide8Layout>);
static_assert(DoubleLayout<Wide8LayoutF64> && !DoubleLayout<Wide8Layout>);
static_assert(Layout<PairsOnlyLayout> && answers_query<PairsOnlyLayout>(Query::self_pairs));
static_assert(!answers_query<PairsOnlyLayout>(Query::tree_pairs));
static_assert(answers_query<PackedLayout>(Query::closest_points));

static_assert(Optimizer<ReinsertionOptimizer>);
static_assert(PairSinkType<CountPairs> && PairSinkType<AppendPairs> && PairSinkType<SwappedPairs>);
static_assert(detail::Splitter<detail::ItemSplitter<std::size_t (*)(std::span<BuildItem>)>>);

struct Nameless {
    Tree build(Boxes, const Executor&) const;
};
struct ReturnsNothing {
    static constexpr std::string_view name = "x", summary = "x";
    void build(Boxes, const Executor&) const;
};
struct SettingsOfAnother {
    static constexpr std::string_view name = "x", summary = "x";
    static std::array<Setting<PlocBuilder>, 0> settings();
    Tree build(Boxes, const Executor&) const;
    void improve(Tree&, const Executor&) const;
};
struct NotFromATree {
    static constexpr std::string_view name = "x", summary = "x";
    std::size_t bytes() const;
};
struct NoPolicy {
    static constexpr std::string_view name = "x", summary = "x";
    void start(detail::MovingTree&, Boxes, const Executor&);
};
static_assert(!Builder<Nameless> && !Builder<ReturnsNothing> && !Builder<SettingsOfAnother>);
static_assert(!Layout<NotFromATree> && !Optimizer<ReturnsNothing> && !Optimizer<SettingsOfAnother>);
static_assert(!detail::UpdatePolicy<NoPolicy> && !PairSinkType<Nameless>);
static_assert(!ExecutorType<Executor> && !ExecutorType<Nameless>);

TEST(Registries, NamesAreUniqueAndExplained) {
    const auto check = [](const auto& entries) {
        std::set<std::string_view> names;
        for (const auto& entry : entries) {
            EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
            EXPECT_FALSE(entry.summary.empty()) << entry.name;
            EXPECT_EQ(entry.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"),
                      std::string_view::npos)
                << entry.name;
        }
        EXPECT_FALSE(names.empty());
    };
    check(builders());
    check(layouts());
    check(traversals());
    check(executors());
    check(optimizers());
    check(updates());
}

TEST(Registries, UnknownNamesThrowWithASuggestion) {
    const auto complaint = [](auto find, std::string_view name) -> std::string {
        try {
            find(name);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "nothing was thrown";
    };
    EXPECT_EQ(complaint(find_update, "autoo"),
              "unknown update policy 'autoo'; did you mean 'auto'?");
    EXPECT_EQ(complaint(find_builder, "hilbret"),
              "unknown builder 'hilbret'; did you mean 'hilbert'?");
    EXPECT_EQ(complaint(find_layout, "wide9"), "unknown layout 'wide9'; did you mean 'wide4'?");
    EXPECT_EQ(complaint([](std::string_view name) { make_builder(name); }, "ploc+reinsertio"),
              "unknown optimizer 'reinsertio'; did you mean 'reinsertion'?");
    EXPECT_EQ(complaint([](std::string_view name) { make_executor(name, 2); }, "tbbb"),
              "unknown executor 'tbbb'; did you mean 'tbb'?");
    const Wide8Layout none(Tree(), serial());
    EXPECT_EQ(complaint(
                  [&](std::string_view kernel) {
                      rays(none, {}, RayQuery::any, kernel, {}, serial(), {});
                  },
                  "watertigth"),
              "unknown ray kernel 'watertigth'; did you mean 'watertight'?");
}

} // namespace
} // namespace boxwood
