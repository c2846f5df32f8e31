#include "scenes/sampling/random.h"

#include <gtest/gtest.h>

#include <set>

namespace boxwood {
namespace {

// Known answer of the authors of Philox (Random123's kat_vectors): counter 0, key 0, 10 rounds.
TEST(Random, IsPhilox4x32WithTenRounds) {
    Draws draws = Random(0, std::uint32_t{0}).item(0);
    for (const std::uint32_t word : {0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u})
        EXPECT_EQ(draws.word(), word);
}

TEST(Random, AnItemDependsOnNothingButItsNumber) {
    const Random random(7, "a");
    Draws late = random.item(5);
    for (std::uint64_t i = 0; i < 5; ++i)
        random.item(i).uniform();
    Draws again = random.item(5);
    for (int k = 0; k < 20; ++k)
        EXPECT_EQ(late.word(), again.word());
}

TEST(Random, SeedStreamItemAndDrawAllMatter) {
    std::set<double> seen;
    for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 32})
        for (const char* stream : {"a", "b"})
            for (const std::uint64_t item :
                 {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 32}) {
                Draws draws = Random(seed, stream).item(item);
                for (int k = 0; k < 9; ++k)
                    seen.insert(draws.uniform());
            }
    EXPECT_EQ(seen.size(), 3u * 2 * 3 * 9);
}

TEST(Random, UniformNumbersAreMultiplesBelowOneWithTheRightMoments) {
    const int n = 100000;
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        Draws draws = Random(3, "moments").item(static_cast<std::uint64_t>(i));
        const double u = draws.uniform();
        ASSERT_TRUE(u >= 0 && u < 1);
        ASSERT_EQ(std::ldexp(u, 53), std::floor(std::ldexp(u, 53)));
        sum += u;
        squares += u * u;
    }
    EXPECT_NEAR(sum / n, 1 / 2., 0.004); // four standard deviations
    EXPECT_NEAR(squares / n, 1 / 3., 0.004);
}

TEST(Random, UnitVectorsHaveLengthOneAndNoPreferredDirection) {
    const int n = 100000;
    Vec3<double> sum, squares;
    for (int i = 0; i < n; ++i) {
        const Vec3<double> v =
            Random(3, "sphere").item(static_cast<std::uint64_t>(i)).unit_vector();
        ASSERT_NEAR(length(v), 1, 1e-15);
        sum = sum + v;
        squares = squares + Vec3<double>{v.x * v.x, v.y * v.y, v.z * v.z};
    }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(sum[axis] / n, 0, 0.008); // four standard deviations
        EXPECT_NEAR(squares[axis] / n, 1 / 3., 0.004);
    }
}

} // namespace
} // namespace boxwood
