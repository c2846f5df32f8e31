#include "trees/queries/allowed_collisions.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace boxwood {
namespace {

TEST(AllowedCollisions, StartsEmptyAndIsSymmetric) {
    AllowedCollisions allowed(4);
    EXPECT_EQ(allowed.size(), 0u);
    allowed.allow(2, 1);
    EXPECT_TRUE(allowed.allows(1, 2));
    EXPECT_TRUE(allowed.allows(2, 1));
    EXPECT_EQ(allowed.size(), 1u);
    allowed.disallow(1, 2);
    EXPECT_EQ(allowed.size(), 0u);
}

TEST(AllowedCollisions, EveryPairHasItsOwnBit) {
    constexpr std::uint32_t n = 23;
    AllowedCollisions allowed(n);
    std::set<std::pair<std::uint32_t, std::uint32_t>> expected;
    for (std::uint32_t a = 0; a < n; ++a)
        for (std::uint32_t b = 0; b < n; ++b)
            if (a != b && (a * 7 + b * b) % 5 == 0) {
                allowed.allow(a, b);
                expected.insert({std::min(a, b), std::max(a, b)});
            }
    EXPECT_EQ(allowed.size(), expected.size());
    for (std::uint32_t b = 0; b < n; ++b)
        for (std::uint32_t a = 0; a < b; ++a)
            EXPECT_EQ(allowed.allows(a, b), expected.count({a, b}) == 1) << a << ", " << b;
}

TEST(AllowedCollisions, GrowsItemByItem) {
    AllowedCollisions grown(0), expected(40);
    for (std::uint32_t b = 0; b < 40; ++b) {
        grown.add_item();
        for (std::uint32_t a = 0; a < b; ++a)
            if ((a * 5 + b) % 3 == 0) {
                grown.allow(a, b);
                expected.allow(a, b);
            }
    }
    EXPECT_EQ(grown.items(), 40u);
    EXPECT_EQ(grown.size(), expected.size());
    for (std::uint32_t b = 0; b < 40; ++b)
        for (std::uint32_t a = 0; a < b; ++a)
            EXPECT_EQ(grown.allows(a, b), expected.allows(a, b)) << a << ", " << b;
}

TEST(AllowedCollisions, RefusesWhatIsNoPair) {
    AllowedCollisions allowed(3);
    EXPECT_THROW(allowed.allow(1, 1), std::invalid_argument);
    EXPECT_THROW(allowed.allow(0, 3), std::invalid_argument);
    EXPECT_THROW(allowed.disallow(4, 0), std::invalid_argument);
    EXPECT_EQ(AllowedCollisions(0).size(), 0u);
    EXPECT_THROW(AllowedCollisions(1).allow(0, 1), std::invalid_argument);
}

TEST(AllowedCollisions, NeighboursOfAChain) {
    const AllowedCollisions allowed = allow_neighbours(4);
    EXPECT_EQ(allowed.size(), 3u);
    EXPECT_TRUE(allowed.allows(0, 1) && allowed.allows(1, 2) && allowed.allows(2, 3));
    EXPECT_FALSE(allowed.allows(0, 3));
    EXPECT_EQ(allow_neighbours(0).size(), 0u);
}

/// Records what reaches it, and asks to stop after `max_calls` batches.
class Recorder final : public PairSink {
  public:
    explicit Recorder(std::size_t max_calls) : max_calls_(max_calls) {}
    void begin(std::size_t chunks, bool in_order) override {
        chunks_ = chunks;
        in_order_ = in_order;
    }
    bool take(std::size_t chunk, std::span<const Pair> batch) override {
        ++batches_;
        last_chunk_ = chunk;
        pairs_.insert(pairs_.end(), batch.begin(), batch.end());
        return batches_ < max_calls_;
    }
    void end() override { ended_ = true; }

    std::size_t max_calls_, chunks_ = 0, batches_ = 0, last_chunk_ = 0;
    bool in_order_ = false, ended_ = false;
    std::vector<Pair> pairs_;
};

TEST(FilteredPairs, DropsTheAllowedAndKeepsTheOrder) {
    const AllowedCollisions allowed = allow_neighbours(2000);
    Recorder recorder(1000);
    auto sink = without_allowed(allowed, recorder);
    std::vector<Pair> pairs, expected;
    for (std::uint32_t i = 0; i + 2 < 2000; ++i) {
        pairs.push_back({i, i + 1});
        pairs.push_back({i, i + 2});
        expected.push_back({i, i + 2});
    }
    sink.begin(7, true);
    EXPECT_TRUE(sink.take(3, pairs)); // far more than one batch
    EXPECT_TRUE(sink.take(4, {}));
    sink.end();
    EXPECT_EQ(recorder.pairs_, expected);
    EXPECT_EQ(recorder.chunks_, 7u);
    EXPECT_EQ(recorder.last_chunk_, 3u) << "an empty batch need not be handed on";
    EXPECT_TRUE(recorder.in_order_ && recorder.ended_);
}

TEST(FilteredPairs, HandsTheWishToStopBack) {
    const AllowedCollisions allowed(1000);
    Recorder recorder(1);
    auto sink = without_allowed(allowed, recorder);
    const std::vector<Pair> pairs(600, Pair{0, 1});
    sink.begin(1, true);
    EXPECT_FALSE(sink.take(0, pairs));
    EXPECT_EQ(recorder.batches_, 1u);
}

} // namespace
} // namespace boxwood
