#include "bench/commands/demos/demo.h"

#include "scenes/robots/four_link.h"
#include "trees/builder.h"
#include "trees/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

namespace boxwood::bench {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

/// Step `number` of the demo, without its heading.
std::string step(int number) {
    const std::string text = four_link_demo();
    const std::size_t first = text.find("\n" + std::to_string(number) + ". ");
    const std::size_t last = text.find("\n" + std::to_string(number + 1) + ". ");
    EXPECT_NE(first, std::string::npos) << number;
    return text.substr(first, last == std::string::npos ? last : last - first);
}

TEST(FourLinkDemo, FindsTheTwoPairsAndPrunesFour) {
    EXPECT_THAT(step(2), HasSubstr("4 x 3 / 2 = 6 box tests"));
    EXPECT_THAT(step(3), ContainsRegex("├── \\{base, shoulder\\} +x \\[-0.32, 0.82\\]"));
    EXPECT_THAT(step(4), HasSubstr("{base, shoulder} against {elbow, wrist}: apart -> 4 pairs "
                                   "pruned by one test"));
    EXPECT_THAT(step(4), HasSubstr("Pairs found: (base, shoulder), (elbow, wrist)."));
    EXPECT_THAT(step(4), HasSubstr("3 box tests instead of 6; 3 of 6 pairs"));
}

TEST(FourLinkDemo, AllowedPairsAreDropped) {
    EXPECT_THAT(step(5), HasSubstr("Left to report: 0."));
    EXPECT_THAT(step(6),
                HasSubstr("Overlapping: (base, shoulder), (shoulder, elbow), (elbow, wrist)."));
    EXPECT_THAT(step(6), HasSubstr("reported: none."));
}

TEST(FourLinkDemo, TheFoldedWristMeetsTheBase) {
    EXPECT_THAT(step(7),
                HasSubstr("3 of 7 nodes changed, bottom-up: wrist, {elbow, wrist}, {base"));
    EXPECT_THAT(step(7), ContainsRegex("└── wrist +x \\[-0.2, 0\\]")); // drawn after the refit
    EXPECT_THAT(step(8), HasSubstr("reported: (base, wrist)."));
    EXPECT_THAT(step(8), HasSubstr("wrist meets base"));
}

TEST(FourLinkDemo, TheTraversalShownCountsWhatTheLibraryCounts) {
    int at = 4;
    for (const auto& angles : {four_link_straight, four_link_bent, four_link_folded}) {
        // The tree is built straight and refitted in the demo; its shape is the same by hand here.
        const auto straight = four_link_boxes(four_link_straight);
        Tree tree = find_builder("median").make({})(straight, serial());
        const auto boxes = four_link_boxes(angles);
        for (std::size_t i = tree.nodes.size(); i-- > 0;)
            tree.nodes[i].box = tree.is_leaf(i) ? boxes[tree.item(i)]
                                                : merge(tree.nodes[Tree::left(i)].box,
                                                        tree.nodes[tree.right(i)].box);
        CountPairs sink;
        const Work work = find_layout("binary").make(tree, serial())->self_pairs_counted(sink);
        const std::string text = step(at);
        const std::regex line("\n +test [0-9]+: ");
        EXPECT_EQ(std::distance(std::sregex_iterator(text.begin(), text.end(), line), {}),
                  static_cast<std::ptrdiff_t>(work.box_tests))
            << text;
        at += 2;
    }
}

} // namespace
} // namespace boxwood::bench
