#include "trees/world/allowed_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <stdexcept>

namespace boxwood {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Reason = AllowedReason;

TEST(AllowedPairs, ByNameAndIndexInEitherOrder) {
    AllowedPairs allowed({"base", "arm", "hand"});
    EXPECT_EQ(allowed.size(), 0u);
    allowed.allow("hand", "arm", Reason::adjacent);
    allowed.allow(0, 2, Reason::sampled, "never in 1000 samples, seed 7");
    EXPECT_TRUE(allowed.allows(1, 2) && allowed.allows(2, 1) && allowed.allows("arm", "hand"));
    EXPECT_FALSE(allowed.allows("base", "arm"));
    EXPECT_EQ(allowed.reason("arm", "hand"), Reason::adjacent);
    EXPECT_EQ(allowed.reason(2, 0), Reason::sampled);
    EXPECT_EQ(allowed.reason(0, 1), std::nullopt);
    EXPECT_THAT(allowed.pairs(),
                ElementsAre(AllowedPair{0, 2, Reason::sampled, "never in 1000 samples, seed 7"},
                            AllowedPair{1, 2, Reason::adjacent}));
    EXPECT_TRUE(allowed.matrix().allows(2, 1));
    allowed.disallow("hand", "base");
    EXPECT_FALSE(allowed.allows(0, 2));
    EXPECT_EQ(allowed.size(), 1u);
    EXPECT_EQ(allowed.matrix().size(), 1u);
}

TEST(AllowedPairs, ThePairsMakeItAgain) {
    AllowedPairs allowed({"a", "b", "", ""});
    allowed.allow(3, 2, Reason::user, "cable");
    allowed.allow(3, 2, Reason::always); // replaces
    allowed.allow(0, 3, Reason::never);
    const AllowedPairs again({"a", "b", "", ""}, allowed.pairs());
    EXPECT_EQ(again.pairs(), allowed.pairs());
    EXPECT_EQ(again.reason(2, 3), Reason::always);
}

TEST(AllowedPairs, ItemsMayCome) {
    AllowedPairs allowed;
    EXPECT_EQ(allowed.add_item("table"), 0u);
    EXPECT_EQ(allowed.add_item(), 1u);
    EXPECT_EQ(allowed.add_item("tool"), 2u);
    allowed.allow("table", "tool", Reason::user);
    EXPECT_EQ(allowed.add_item("part"), 3u);
    EXPECT_TRUE(allowed.allows(0, 2));
    EXPECT_FALSE(allowed.allows(0, 3) || allowed.allows(1, 2) || allowed.allows(2, 3));
    EXPECT_EQ(allowed.name(3), "part");
    EXPECT_EQ(allowed.items(), 4u);
}

TEST(AllowedPairs, RefusesUnknownNamesAndWhatIsNoPair) {
    AllowedPairs allowed({"panda_hand", "panda_link7"});
    EXPECT_THAT([&] { allowed.allow("panda_hnd", "panda_link7", Reason::user); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("did you mean 'panda_hand'")));
    EXPECT_THROW(allowed.allow("panda_hand", "panda_hand", Reason::user), std::invalid_argument);
    EXPECT_THROW(allowed.allow(0, 2, Reason::user), std::invalid_argument);
    EXPECT_THROW(allowed.allows("", "panda_hand"), std::invalid_argument);
    EXPECT_THROW(AllowedPairs({"a", "b", "a"}), std::invalid_argument);
    EXPECT_THROW(allowed.add_item("panda_hand"), std::invalid_argument);
    EXPECT_EQ(allowed.items(), 2u);
    EXPECT_EQ(allowed.size(), 0u);
}

TEST(AllowedPairs, AgreesWithAMapOnRandomChanges) {
    constexpr std::uint32_t n = 40;
    AllowedPairs allowed((std::vector<std::string>(n)));
    std::map<std::pair<std::uint32_t, std::uint32_t>, Reason> expected;
    std::mt19937 random(3);
    const auto any = [&] { return static_cast<std::uint32_t>(random() % n); };
    for (int change = 0; change < 20000; ++change) {
        const std::uint32_t a = any(), b = any();
        if (a == b)
            continue;
        const std::pair pair(std::min(a, b), std::max(a, b));
        const auto reason = static_cast<Reason>(random() % 6);
        if (random() % 3 == 0) {
            allowed.disallow(a, b);
            expected.erase(pair);
        } else {
            allowed.allow(a, b, reason);
            expected[pair] = reason;
        }
        ASSERT_EQ(allowed.allows(a, b), expected.count(pair) == 1);
    }
    const std::vector<AllowedPair> pairs = allowed.pairs();
    ASSERT_EQ(pairs.size(), expected.size());
    ASSERT_EQ(allowed.matrix().size(), expected.size());
    auto next = expected.begin();
    for (const AllowedPair& pair : pairs) {
        EXPECT_EQ(std::pair(pair.a, pair.b), next->first);
        EXPECT_EQ(pair.reason, next->second);
        ++next;
    }
}

} // namespace
} // namespace boxwood
