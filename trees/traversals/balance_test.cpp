#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/layouts/layouts.h"
#include "trees/testing/box_families.h"
#include "trees/testing/layouts_answering.h"

#include <gtest/gtest.h>

#include <algorithm>

/// Work is cut by the input alone, so its balance is a matter of counting: what the heaviest chunk
/// holds of all answers.
namespace boxwood {
namespace {

/// Counts the answers of each chunk.
class ChunkSizes final : public PairSink {
  public:
    void begin(std::size_t chunks, bool) override { sizes_.assign(chunks, 0); }
    bool take(std::size_t chunk, std::span<const Pair> pairs) override {
        sizes_[chunk] += pairs.size();
        return true;
    }
    void end() override {}

    double heaviest() const {
        std::size_t all = 0;
        for (const std::size_t size : sizes_)
            all += size;
        return all ? static_cast<double>(std::ranges::max(sizes_)) / static_cast<double>(all) : 1;
    }

  private:
    std::vector<std::size_t> sizes_;
};

/// 12,000 boxes in the unit cube, each on hundreds of others, and 300 in a space a thousand times
/// as wide.
std::vector<Box> giant_cluster(std::uint32_t seed) {
    std::vector<Box> boxes = random_boxes(300, .1f, seed);
    for (Box& box : boxes)
        for (Vec3<float>* p : {&box.min, &box.max})
            *p = 1000.0f * *p;
    for (const Box& box : random_boxes(12000, .08f, seed + 1))
        boxes.push_back(box);
    return boxes;
}

/// The layouts that answer the query by a traversal of ours; one of its own may cut as it likes.
std::vector<LayoutEntry> traversed_layouts(Query query) {
    std::vector<LayoutEntry> found = layouts_answering({query});
    std::erase_if(found, [](const LayoutEntry& entry) {
#define X(layout, type) entry.name != #layout&&
        return BOXWOOD_TRAVERSED_LAYOUTS(X) true;
#undef X
    });
    return found;
}

TEST(Balance, NoChunkOfOneTreeHasMostOfTheWork) {
    // A giant cluster far from the few others, and one that is all the same box.
    const std::vector<Box> same(6000, Box{{0, 0, 0}, {1, 1, 1}});
    for (const std::vector<Box>& boxes : {giant_cluster(5), same})
        for (const std::string_view builder : {"median", "binned_sah"}) {
            const Tree tree = find_builder(builder).make({})(boxes, serial());
            for (const LayoutEntry& entry : traversed_layouts(Query::self_pairs)) {
                SCOPED_TRACE(std::string(builder) + "." + std::string(entry.name));
                ChunkSizes chunks;
                entry.make(tree, serial())->self_pairs(serial(), chunks);
                EXPECT_LT(chunks.heaviest(), 1. / 8);
            }
        }
}

TEST(Balance, NoChunkOfTwoTreesHasMostOfTheWork) {
    const std::vector<Box> a = giant_cluster(5), b = giant_cluster(7),
                           same(3000, Box{{0, 0, 0}, {1, 1, 1}}), few(3, same[0]),
                           many(5000, same[0]);
    for (const std::string_view builder : {"median", "binned_sah"}) {
        const auto tree_of = [&](const std::vector<Box>& boxes) {
            return find_builder(builder).make({})(boxes, serial());
        };
        const Tree tree_a = tree_of(a), tree_b = tree_of(b), tree_same = tree_of(same),
                   tree_few = tree_of(few), tree_many = tree_of(many);
        for (const LayoutEntry& entry : traversed_layouts(Query::tree_pairs)) {
            SCOPED_TRACE(std::string(builder) + "." + std::string(entry.name));
            const auto heaviest = [&](const Tree& first, const Tree& second) {
                ChunkSizes chunks;
                entry.make(first, serial())
                    ->tree_pairs(*entry.make(second, serial()), serial(), chunks);
                return chunks.heaviest();
            };
            EXPECT_LT(heaviest(tree_a, tree_b), .15);
            EXPECT_LT(heaviest(tree_same, tree_same), .125);
            EXPECT_LT(heaviest(tree_few, tree_many), .125);
            EXPECT_LT(heaviest(tree_many, tree_few), .125);
        }
    }
}

TEST(Balance, NoChunkOfQueriesHasMostOfTheWork) {
    const std::vector<Box> items = giant_cluster(9);
    const std::vector<Box> regions = giant_cluster(11); // most meet the cluster
    std::vector<Sphere<float>> balls;
    for (const Box& region : regions)
        balls.push_back({region.min, .1f});
    for (const LayoutEntry& entry : layouts_answering({Query::regions})) {
        SCOPED_TRACE(entry.name);
        const auto layout = entry.make(find_builder("median").make({})(items, serial()), serial());
        ChunkSizes chunks;
        layout->regions(regions, serial(), chunks);
        EXPECT_LT(chunks.heaviest(), .125);
        layout->regions(balls, serial(), chunks);
        EXPECT_LT(chunks.heaviest(), .125);
    }
}

} // namespace
} // namespace boxwood
