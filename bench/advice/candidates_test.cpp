#include "bench/advice/candidates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using ::testing::ElementsAre;

Way way(const char* builder, const char* layout, double build_ns, double query_ns) {
    Way made;
    made.builder = builder;
    made.layout = layout;
    made.build_ns = build_ns;
    made.query_ns = query_ns;
    return made;
}

TEST(Candidates, AreThoseThatMayBeBestForSomeNumberOfQueries) {
    Advice first;
    first.n_queries = 1000;
    first.ways = {way("hilbert", "wide8", 1e6, 9e5),
                  way("near", "wide8", 1.05e6, 9.2e5), // within 1.2 times hilbert
                  way("far", "wide8", 2.9e6, 8.9e5),   // better in both is none, but it is too slow
                  way("binned_sah", "wide8", 3e6, 4e5),
                  way("worse", "wide8", 4e6, 4.3e5), // binned_sah is better in both
                  way("binned_sah", "packed", 2e6, 9e5),
                  way("binned_sah", "binary", 3.4e6, 4.3e5), // wide8 is better in both
                  way("ploc", "quantised8", 9e5, 9e5)};      // another layout
    const Candidates found = candidates_of(first, "wide8", "binned_sah");
    EXPECT_THAT(found.builders, ElementsAre("hilbert", "near", "binned_sah"));
    EXPECT_THAT(found.layouts, ElementsAre("packed", "wide8"));
}

TEST(Candidates, FewQueriesAndManyCount) {
    Advice first;
    first.ways = {way("a", "wide8", 1, 100), way("b", "wide8", 1e9, 1)}; // from 10^7 queries on
    EXPECT_THAT(candidates_of(first, "wide8", "a").builders, ElementsAre("a", "b"));
    EXPECT_THAT(candidates_of(first, "wide8", "a").layouts, ElementsAre("wide8"));
    EXPECT_THAT(candidates_of(first, "packed", "c").builders, ElementsAre());
    // Where another way is far ahead, those of the layout are not asked about.
    first.n_queries = 1000;
    first.ways = {way("a", "wide8", 10, 100), way("b", "wide8", 30, 1), way("c", "packed", 4, 40)};
    EXPECT_THAT(candidates_of(first, "wide8", "a").builders, ElementsAre("b"));
}

} // namespace
} // namespace boxwood::bench
