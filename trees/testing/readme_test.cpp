/// The builder of README.md (readme_examples.cmake cuts it out) does what README.md says of it.

#include "trees/builder.h"
#include "trees/inspect/validate.h"
#include "trees/layout.h"
#include "trees/testing/box_families.h"
#include "trees/testing/brute_force.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood {

BuilderEntry halving_builder();

namespace {

TEST(Readme, TheBuilderIsValidAndFindsThePairsOfBruteForce) {
    const BuilderEntry halving = halving_builder();
    EXPECT_EQ(halving.name, "halving");
    for (const auto& [family, boxes] : box_families()) {
        const Tree tree = halving.make({})(boxes, serial());
        EXPECT_EQ(validate(tree, boxes), std::nullopt) << family;
        for (const LayoutEntry& layout : layouts()) {
            std::vector<Pair> pairs;
            AppendPairs sink(pairs);
            layout.make(tree, serial())->self_pairs(serial(), sink);
            std::ranges::sort(pairs);
            EXPECT_EQ(pairs, brute_force(boxes)) << family << ", " << layout.name;
        }
    }
}

} // namespace
} // namespace boxwood
