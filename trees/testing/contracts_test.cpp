#include "trees/builder.h"
#include "trees/builders/binned_sah.h"
#include "trees/builders/hilbert.h"
#include "trees/builders/incremental.h"
#include "trees/builders/median.h"
#include "trees/layouts/binary.h"
#include "trees/layouts/packed.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"

#include <gtest/gtest.h>

#include <set>

namespace boxwood {
namespace {

static_assert(Builder<MedianBuilder> && Builder<BinnedSahBuilder> && Builder<IncrementalBuilder>);
static_assert(Layout<BinaryLayout> && Layout<BinaryLayoutF64>);
static_assert(Layout<Wide8Layout> && Layout<Wide8LayoutF64> && Layout<Quantised8Layout>);
static_assert(WideTree<Wide4Layout> && WideTree<Wide16Layout> && WideTree<Quantised8Layout>);
static_assert(Builder<HilbertBuilder> && Layout<PackedLayout> && WideTree<PackedLayout>);
static_assert(!WideTree<BinaryLayout>);

struct Nameless {
    Tree build(Boxes, const Executor&) const;
};
struct ReturnsNothing {
    static constexpr std::string_view name = "x", summary = "x";
    void build(Boxes, const Executor&) const;
};
struct NotFromATree {
    static constexpr std::string_view name = "x", summary = "x";
    std::size_t bytes() const;
};
static_assert(!Builder<Nameless> && !Builder<ReturnsNothing> && !Layout<NotFromATree>);

TEST(Catalogues, WordsAreUniqueAndExplained) {
    const auto check = [](const auto& entries) {
        std::set<std::string_view> words;
        for (const auto& entry : entries) {
            EXPECT_TRUE(words.insert(entry.name).second) << entry.name;
            EXPECT_FALSE(entry.summary.empty()) << entry.name;
            EXPECT_EQ(entry.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"),
                      std::string_view::npos)
                << entry.name;
        }
        EXPECT_FALSE(words.empty());
    };
    check(builders());
    check(layouts());
    check(traversals());
    check(executors());
}

} // namespace
} // namespace boxwood
