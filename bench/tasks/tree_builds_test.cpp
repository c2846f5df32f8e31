#include "bench/tasks/tree_builds.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace boxwood::bench {
namespace {

Scene boxes_of(std::size_t n) {
    SceneSpec spec;
    spec.generator = "uniform";
    spec.n = n;
    return make_scene(spec);
}

std::vector<ContenderEntry> all_contenders() {
    std::vector<ContenderEntry> all = peers_that_answer(Ask::tree);
    for (const BuilderEntry& builder : builders())
        all.push_back(our_contender({std::string(builder.name), {}, "wide8", ""}, Ask::tree));
    return all;
}

TEST(TreeBuilds, AreExactForOursAndPeersAlsoWhenBuiltAgain) {
    for (const std::size_t n : {1u, 2u, 3u, 5000u}) {
        const Scene scene = boxes_of(n);
        for (const ContenderEntry& entry : all_contenders())
            for (const unsigned threads : {1u, 2u}) {
                const Job job{&scene, Ask::tree, threads == 1 ? "serial" : "tbb", threads};
                if (entry.unsupported(job))
                    continue;
                const auto contender = entry.make(job);
                for (int again = 0; again < 2; ++again) {
                    contender->build();
                    const results::Check check = check_tree(*contender, scene);
                    EXPECT_EQ(check.status, "exact") << entry.name << ": " << check.witness;
                    EXPECT_GE(check.n_got, n) << entry.name;
                    EXPECT_GT(contender->structure()->bytes, 0u);
                }
            }
    }
}

TEST(TreeBuilds, AreNamedByBuilderAlone) {
    const ContenderEntry entry =
        our_contender({"binned_sah", {{"bins", 8}}, "binary", ""}, Ask::tree);
    EXPECT_EQ(entry.name, "binned_sah_bins8.tree");
    EXPECT_EQ(entry.builder, "binned_sah_bins8");
    EXPECT_TRUE(entry.layout.empty() && entry.traversal.empty());
    EXPECT_THROW(our_contender({"medain", {}, "wide8", ""}, Ask::tree), std::invalid_argument);
}

class GivenTree final : public Contender {
  public:
    explicit GivenTree(Tree tree) : tree_(std::move(tree)) {}
    void build() override {}
    void query(Answers&) override {}
    std::optional<StructureInfo> structure() const override { return StructureInfo{0, &tree_}; }

  private:
    Tree tree_;
};

TEST(TreeBuilds, FaultsAreFound) {
    const Scene scene = boxes_of(100);
    const auto broken = [&](auto break_it) {
        Tree tree = make_builder("median")(scene.boxes, serial());
        break_it(tree);
        return check_tree(GivenTree(std::move(tree)), scene);
    };
    EXPECT_EQ(broken([](Tree&) {}).status, "exact");
    EXPECT_EQ(broken([](Tree& t) { t.is_split = true; }).status, "exact");
    for (const bool split : {false, true}) {
        const auto item_lost = broken([&](Tree& t) {
            t.is_split = split;
            t.order[3] = t.order[4];
        });
        EXPECT_EQ(item_lost.status, "wrong");
        EXPECT_FALSE(item_lost.witness.empty());
        EXPECT_EQ(broken([&](Tree& t) {
                      t.is_split = split;
                      t.nodes[0].box.max.x += 1;
                  }).status,
                  "wrong");
        EXPECT_EQ(broken([&](Tree& t) {
                      t.is_split = split;
                      t.order[7] = 100;
                  }).status,
                  "wrong");
    }
}

} // namespace
} // namespace boxwood::bench
