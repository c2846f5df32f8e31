#include "trees/cuda/triangles/triangle_distances.cuh"

#include "kernels/testing/distance_pairs.h"
#include "kernels/triangle_distance/certified.h"
#include "kernels/triangle_distance/features.h"
#include "trees/cuda/testing/families.h"
#include "trees/cuda/testing/triangle_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace boxwood::cuda {
namespace {

using testing::DistancePair;

struct OnDevice : PairsOnDevice {
    std::vector<Bounds> bounds;

    template <class Of>
    explicit OnDevice(const std::vector<Of>& of) : PairsOnDevice(of), bounds(of.size()) {}
    const std::vector<Bounds>& measure(Accuracy accuracy) {
        measure_triangles(accuracy,
                          {side(0), side(1), view(), bounds.data(), none_uncertain(), &n_wide}, {});
        return bounds;
    }
    Least least() {
        Least found = no_least;
        least_distance(bounds.data(), view(), &found, {});
        return found;
    }
};

struct Family {
    std::string name;
    std::vector<DistancePair> pairs; ///< corners are floats
};

const std::vector<Family>& families() {
    static const std::vector<Family> made = [] {
        std::vector<Family> all;
        const auto add = [&all](std::string_view name, std::size_t n, const auto& make) {
            Family& family = all.emplace_back(Family{std::string(name), {}});
            for (int i = 0; i < testing::few(static_cast<int>(n)); ++i) {
                const auto [a, b] = make();
                family.pairs.emplace_back(testing::as<double>(testing::as<float>(a)),
                                          testing::as<double>(testing::as<float>(b)));
            }
        };
        testing::DistanceFamilies from(3);
        std::vector<testing::DistanceFamilies::Family> makers = from.ordinary();
        for (const auto& more :
             {from.near_contact(), from.thin(), std::vector{from.near_parallel_edges()}})
            makers.insert(makers.end(), more.begin(), more.end());
        for (const auto& maker : makers)
            add(maker.name, 60, [&] {
                const auto pair = maker.make();
                return std::pair{from.triangle(pair.a), from.triangle(pair.b)};
            });
        testing::PairFamilies touching(4, testing::Kept::as_float);
        const auto add_all = [&](std::string_view name,
                                 const std::vector<testing::TrianglePair>& pairs) {
            std::size_t at = 0;
            add(name, pairs.size(), [&] {
                const testing::TrianglePair& pair = pairs[at++];
                return std::pair{pair.a, pair.b};
            });
        };
        add_all("small grid", touching.grid(200, 3));
        add_all("denormal grid", touching.grid(60, 5, -149));
        add_all("huge grid", touching.grid(60, 3, 125));
        add_all("nearly touching as floats", touching.nearly_touching(200));
        add_all("wide exponents", touching.magnitudes(60, -40, 40));
        add_all("any exponents", touching.magnitudes(60, -149, 126));
        return all;
    }();
    return made;
}

template <class Expect> void for_each_pair(const Family& family, Accuracy accuracy, Expect expect) {
    SCOPED_TRACE(family.name);
    OnDevice made(family.pairs);
    made.measure(accuracy);
    std::vector<bool> uncertain(family.pairs.size());
    for (std::uint32_t k = 0; k < made.n_uncertain; ++k) {
        EXPECT_FALSE(uncertain[made.places[k]]);
        uncertain[made.places[k]] = true;
    }
    for (std::uint32_t k = 0; k < family.pairs.size(); ++k) {
        const DistancePair& pair = family.pairs[made.candidates[k].a];
        SCOPED_TRACE(pair.print());
        expect(pair, made.bounds[k], uncertain[k]);
    }
}

void expect_around(const DistancePair& pair, const Bounds& bounds) {
    EXPECT_LE(oracle::compare(bounds.lo, pair.squared), 0);
    EXPECT_GE(oracle::compare(bounds.hi, pair.squared), 0);
}

TEST(TriangleDistancesOnDevice, ArePlainlyThoseOfTheCpu) {
    for (const Family& family : families()) {
        for_each_pair(family, Accuracy::plain, [](const DistancePair& pair, Bounds found, bool) {
            const Distance wanted =
                FeaturesF32::distance(testing::as<float>(pair.a), testing::as<float>(pair.b));
            EXPECT_EQ(found.lo, wanted.distance);
            EXPECT_EQ(found.hi, wanted.distance);
        });
        for_each_pair(family, Accuracy::plain_in_doubles,
                      [](const DistancePair& pair, Bounds found, bool) {
                          const Distance wanted = FeaturesF64::distance(pair.a, pair.b);
                          EXPECT_EQ(found.lo, wanted.distance);
                          EXPECT_EQ(found.hi, wanted.distance);
                      });
    }
}

TEST(TriangleDistancesOnDevice, AreWithinCertifiedBounds) {
    std::size_t n_sure = 0, n_all = 0;
    for (const Family& family : families())
        for_each_pair(family, Accuracy::certified,
                      [&](const DistancePair& pair, Bounds found, bool uncertain) {
                          expect_around(pair, found);
                          ++n_all;
                          if (uncertain)
                              return;
                          ++n_sure;
                          EXPECT_GE(found.lo, found.hi * (1 - 0x1p-32));
                          const Distance cpu = CertifiedDistance::distance(pair.a, pair.b);
                          // Of the same steps, but for what is all one point.
                          EXPECT_TRUE(cpu.tier == 0 || found.hi == 0);
                          EXPECT_EQ(found.lo, cpu.lo);
                          EXPECT_EQ(found.hi, cpu.hi);
                      });
    EXPECT_GT(n_sure, n_all / 4);
}

TEST(TriangleDistancesOnDevice, AreExactlyThoseOfTheOracle) {
    for (const Family& family : families())
        for (const std::uint64_t seed : {1, 2}) {
            on_host::set_seed(seed);
            for_each_pair(family, Accuracy::exact,
                          [](const DistancePair& pair, Bounds found, bool uncertain) {
                              expect_around(pair, found);
                              EXPECT_EQ(found.hi == 0, pair.touch());
                              EXPECT_GE(found.lo, found.hi * (1 - (uncertain ? 0x1p-47 : 0x1p-32)));
                          });
        }
}

/// The filter measures most; here each length of integers all that it can hold.
TEST(TriangleDistancesOnDevice, AreExactByEachLengthOfIntegers) {
    std::size_t n_short = 0;
    for (const Family& family : families())
        for (const DistancePair& pair : family.pairs) {
            SCOPED_TRACE(family.name + ": " + pair.print());
            const auto a = testing::as<float>(pair.a), b = testing::as<float>(pair.b);
            Bounds by_long{}, by_short{};
            ASSERT_TRUE(float_pair::exact_distance<5>(a, b, by_long));
            expect_around(pair, by_long);
            EXPECT_EQ(by_long.hi == 0, pair.touch());
            if (!float_pair::exact_distance<1>(a, b, by_short))
                continue;
            ++n_short;
            EXPECT_EQ(by_short.lo, by_long.lo);
            EXPECT_EQ(by_short.hi, by_long.hi);
        }
    EXPECT_GT(n_short, 1000u / testing::thinned);
}

TEST(TriangleDistancesOnDevice, AreNanWhereNotFinite) {
    testing::PairFamilies make(6, testing::Kept::as_float);
    std::vector<testing::TrianglePair> pairs = make.grid(32 * testing::thinned, 3);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        Triangle<double>& t = i % 2 == 0 ? pairs[i].a : pairs[i].b;
        (i % 3 == 0   ? t.a
         : i % 3 == 1 ? t.b
                      : t.c)[static_cast<int>(i / 2 % 3)] =
            i % 4 < 2 ? std::nan("") : std::numeric_limits<double>::infinity();
    }
    OnDevice made(pairs);
    for (const Accuracy accuracy :
         {Accuracy::plain, Accuracy::plain_in_doubles, Accuracy::certified, Accuracy::exact}) {
        for (const Bounds& bounds : made.measure(accuracy))
            EXPECT_TRUE(std::isnan(bounds.lo) && std::isnan(bounds.hi));
        EXPECT_EQ(made.least().place, no_least.place);
    }
}

TEST(TriangleDistancesOnDevice, TheLeastIsTheFirstOfThem) {
    testing::PairFamilies make(9, testing::Kept::as_float);
    for (const std::size_t size : {0u, 1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 4097u}) {
        std::vector<testing::TrianglePair> pairs = make.generic(size * testing::thinned);
        for (testing::TrianglePair& pair : pairs) // apart, and in a few distances alike
            for (Vec3<double>* p : {&pair.b.a, &pair.b.b, &pair.b.c})
                *p = *p + Vec3<double>{2, 0, 0};
        if (pairs.size() > 200)
            std::copy_n(pairs.begin(), 100, pairs.begin() + 100);
        OnDevice made(pairs);
        for (std::uint64_t seed = 0; seed < (size > 300 ? 1 : fibre_seeds); ++seed) {
            on_host::set_seed(seed);
            made.n = seed % 2 == 0 ? size : size + 9;
            const std::vector<Bounds>& bounds = made.measure(Accuracy::certified);
            const Least found = made.least();
            Least wanted = no_least;
            for (std::uint32_t k = 0; k < size; ++k) {
                wanted.lo = std::min(wanted.lo, bits_as<unsigned long long>(bounds[k].lo));
                if (bits_as<unsigned long long>(bounds[k].hi) < wanted.hi) {
                    wanted.hi = bits_as<unsigned long long>(bounds[k].hi);
                    wanted.place = k;
                }
            }
            EXPECT_EQ(found.lo, wanted.lo);
            EXPECT_EQ(found.hi, wanted.hi);
            EXPECT_EQ(found.place, wanted.place);
        }
    }
}

} // namespace
} // namespace boxwood::cuda
