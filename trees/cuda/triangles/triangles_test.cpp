#include "trees/cuda/triangles/triangles.cuh"

#include "kernels/triangle_triangle/guigue_devillers_batch.h"
#include "trees/cuda/testing/families.h"
#include "trees/cuda/testing/triangle_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace boxwood::cuda {
namespace {

using testing::TrianglePair;

struct Decided : PairsOnDevice {
    std::vector<Answer> answers;

    explicit Decided(const std::vector<TrianglePair>& of)
        : PairsOnDevice(of), answers(of.size(), Answer::maybe) {}
    const std::vector<Answer>& decide(Accuracy accuracy) {
        const TrianglePairs pairs{side(0),        side(1),          view(),
                                  answers.data(), none_uncertain(), &n_wide};
        intersect_triangles(accuracy, pairs, {});
        return answers;
    }
};

struct PairFamily {
    std::string name;
    std::vector<TrianglePair> pairs;
};

/// All corners are floats; the truth is the oracle's.
const std::vector<PairFamily>& pair_families() {
    static const std::vector<PairFamily> made = [] {
        testing::PairFamilies make(5, testing::Kept::as_float);
        std::vector<PairFamily> all{{"generic", make.generic(1000)},
                                    {"small grid", make.grid(1000, 3)},
                                    {"grid", make.grid(500, 1000)},
                                    {"denormal grid", make.grid(500, 5, -149)},
                                    {"huge grid", make.grid(500, 3, 125)},
                                    {"nearly touching", make.nearly_touching(2000)},
                                    {"wide exponents", make.magnitudes(500, -40, 40)},
                                    {"any exponents", make.magnitudes(500, -149, 126)}};
        for (const std::size_t n : {0u, 1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 4097u})
            all.push_back({"generic " + std::to_string(n), make.generic(n)});
        return all;
    }();
    return made;
}

template <class Expect> void for_each_pair(Decided& made, Accuracy accuracy, Expect expect) {
    const std::vector<Answer>& answers = made.decide(accuracy);
    for (std::size_t k = 0; k < answers.size(); ++k)
        expect(made.candidates[k].a, answers[k]);
}

TEST(TrianglesOnDevice, ArePlainlyThoseOfTheCpu) {
    for (const PairFamily& family : pair_families()) {
        SCOPED_TRACE(family.name);
        Decided made(family.pairs);
        for_each_pair(made, Accuracy::plain, [&](std::uint32_t i, Answer answer) {
            const Triangle<float> a = made.triangle(0, i), b = made.triangle(1, i);
            EXPECT_EQ(answer, GuigueDevillersF32Batch::intersect(a, b).answer)
                << print(family.pairs[i]);
        });
        for_each_pair(made, Accuracy::plain_in_doubles, [&](std::uint32_t i, Answer answer) {
            const auto a = testing::as<double>(made.triangle(0, i)),
                       b = testing::as<double>(made.triangle(1, i));
            EXPECT_EQ(answer, GuigueDevillersF64::intersect(a, b).answer) << print(family.pairs[i]);
        });
    }
}

TEST(TrianglesOnDevice, AreNeverWrongWhereCertified) {
    for (const PairFamily& family : pair_families()) {
        SCOPED_TRACE(family.name);
        for (std::uint64_t seed = 0; seed < (family.pairs.size() > 300 ? 2 : fibre_seeds); ++seed) {
            on_host::set_seed(seed);
            Decided made(family.pairs);
            std::uint32_t n_maybe = 0;
            for_each_pair(made, Accuracy::certified, [&](std::uint32_t i, Answer answer) {
                n_maybe += answer == Answer::maybe;
                EXPECT_NE(answer, family.pairs[i].touch ? Answer::no : Answer::yes)
                    << print(family.pairs[i]);
            });
            ASSERT_EQ(made.n_uncertain, n_maybe);
            std::sort(made.places.data(), made.places.data() + n_maybe);
            for (std::uint32_t k = 0; k < n_maybe; ++k) {
                EXPECT_EQ(made.answers[made.places[k]], Answer::maybe);
                EXPECT_TRUE(k == 0 || made.places[k - 1] < made.places[k]);
            }
        }
    }
}

TEST(TrianglesOnDevice, AreExactlyThoseOfTheOracle) {
    std::uint32_t n_wide = 0;
    for (const PairFamily& family : pair_families()) {
        SCOPED_TRACE(family.name);
        for (std::uint64_t seed = 0; seed < (family.pairs.size() > 300 ? 2 : fibre_seeds); ++seed) {
            on_host::set_seed(seed);
            Decided made(family.pairs);
            for_each_pair(made, Accuracy::exact, [&](std::uint32_t i, Answer answer) {
                ASSERT_EQ(answer, family.pairs[i].touch ? Answer::yes : Answer::no)
                    << print(family.pairs[i]);
                ASSERT_EQ(
                    answer,
                    GuigueDevillersExact::intersect(family.pairs[i].a, family.pairs[i].b).answer);
            });
            n_wide += made.n_wide;
        }
    }
    EXPECT_GT(n_wide, 0u);
}

/// The filters decide most; here each grid decides all that it can hold.
TEST(TrianglesOnDevice, AreExactOnEachGrid) {
    std::size_t n_narrow = 0;
    for (const PairFamily& family : pair_families()) {
        SCOPED_TRACE(family.name);
        if (family.pairs.size() > 2000)
            continue;
        for (const TrianglePair& pair : family.pairs) {
            const auto a = testing::as<float>(pair.a), b = testing::as<float>(pair.b);
            const Answer truth = pair.touch ? Answer::yes : Answer::no;
            bool fits = false;
            EXPECT_EQ(float_pair::exact_on<float_pair::WideFloats>(a, b, fits), truth)
                << print(pair);
            const Answer narrow = float_pair::exact_on<float_pair::NarrowFloats>(a, b, fits);
            EXPECT_EQ(narrow, fits ? truth : Answer::maybe) << print(pair);
            n_narrow += fits;
        }
    }
    EXPECT_GT(n_narrow, 4000u / testing::thinned);
}

TEST(TrianglesOnDevice, AreUndecidedWhereNotFinite) {
    testing::PairFamilies make(6, testing::Kept::as_float);
    std::vector<TrianglePair> pairs = make.grid(64 * testing::thinned, 3);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        TrianglePair& pair = pairs[i];
        Triangle<double>& t = i % 2 == 0 ? pair.a : pair.b;
        Vec3<double>& corner = i % 3 == 0 ? t.a : i % 3 == 1 ? t.b : t.c;
        corner[static_cast<int>(i / 2 % 3)] =
            i % 4 < 2 ? std::nan("") : std::numeric_limits<double>::infinity();
    }
    Decided made(pairs);
    for (const Accuracy accuracy :
         {Accuracy::plain, Accuracy::plain_in_doubles, Accuracy::certified, Accuracy::exact})
        for_each_pair(made, accuracy, [&](std::uint32_t i, Answer answer) {
            const Triangle<float> a = made.triangle(0, i), b = made.triangle(1, i);
            const Answer wanted =
                accuracy == Accuracy::plain ? GuigueDevillersF32Batch::intersect(a, b).answer
                : accuracy == Accuracy::plain_in_doubles
                    ? GuigueDevillersF64::intersect(testing::as<double>(a), testing::as<double>(b))
                          .answer
                    : Answer::maybe;
            EXPECT_EQ(answer, wanted);
        });
}

TEST(TrianglesOnDevice, OfAnIndexedMesh) {
    TriangleMesh mesh;
    std::mt19937 random(3);
    std::uniform_int_distribution<int> coordinate(0, 4);
    const auto any = [&] { return static_cast<float>(coordinate(random)); };
    for (int i = 0; i < 40; ++i)
        mesh.vertices.push_back({any(), any(), any()});
    for (std::uint32_t i = 0; i + 2 < 40; ++i)
        mesh.triangles.push_back({i, i + 1, i + 2});
    std::vector<Pair> candidates;
    for (std::uint32_t a = 0; a < mesh.triangles.size(); ++a)
        for (std::uint32_t b = a + 1; b < mesh.triangles.size(); ++b)
            candidates.push_back({a, b});
    const std::uint64_t n = candidates.size();
    std::vector<Answer> answers(n);
    std::vector<std::uint32_t> places(n);
    std::uint32_t n_uncertain = 0, n_wide = 0;
    const TrianglesView view{mesh.vertices.data(), mesh.triangles[0].data()};
    intersect_triangles(Accuracy::exact,
                        {view,
                         view,
                         {candidates.data(), &n, static_cast<std::uint32_t>(n)},
                         answers.data(),
                         {places.data(), &n_uncertain},
                         &n_wide},
                        {});
    for (std::size_t k = 0; k < n; ++k)
        EXPECT_EQ(answers[k], GuigueDevillersExact::intersect(
                                  testing::as<double>(mesh.triangle(candidates[k].a)),
                                  testing::as<double>(mesh.triangle(candidates[k].b)))
                                  .answer);
}

TEST(TriangleHitsOnDevice, AreInTheOrderOfTheCandidates) {
    testing::PairFamilies make(8, testing::Kept::as_float);
    for (const std::size_t size : {0u, 1u, 33u, 256u, 257u, 4097u}) {
        Decided made(make.generic(size * testing::thinned));
        // More or fewer than there is room for: what was found, and the end of a list.
        for (const std::uint64_t n : {made.n, made.n + 10, made.n / 2})
            for (std::uint64_t seed = 0; seed < (size > 300 ? 1 : 2); ++seed) {
                on_host::set_seed(seed);
                made.n = n;
                made.answers.assign(made.answers.size(), Answer::yes);
                made.decide(Accuracy::exact);
                const std::size_t known = std::min<std::size_t>(n, made.candidates.size());
                std::vector<Pair> wanted;
                for (std::size_t k = 0; k < known; ++k)
                    if (made.answers[k] == Answer::yes)
                        wanted.push_back(made.candidates[k]);
                for (std::size_t k = known; k < made.answers.size(); ++k)
                    EXPECT_EQ(made.answers[k], Answer::yes) << "beyond the last candidate";
                std::vector<Pair> found(wanted.size());
                std::vector<std::uint32_t> at(blocks_for(made.candidates.size(), triangle_threads));
                std::uint64_t n_found = 0;
                compact_hits({made.answers.data(), made.view(), at.data(), found.data(), &n_found},
                             {});
                ASSERT_EQ(n_found, wanted.size());
                ASSERT_EQ(found, wanted);
            }
    }
}

/// Blocks beyond those that are summed at a time.
TEST(TriangleHitsOnDevice, AreSummedOverManyBlocks) {
    std::vector<std::uint32_t> at(2500);
    std::iota(at.begin(), at.end(), 1u);
    std::uint64_t n = 0;
    launch(Stream{}, 1, sum_threads, sum_hits, Hits{nullptr, {}, at.data(), nullptr, &n},
           static_cast<std::uint32_t>(at.size()));
    for (std::uint32_t i = 0; i < at.size(); ++i)
        ASSERT_EQ(at[i], i * (i + 1) / 2);
    EXPECT_EQ(n, 2500u * 2501 / 2);
}

} // namespace
} // namespace boxwood::cuda
