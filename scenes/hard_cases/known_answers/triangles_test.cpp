// Entries of the list of hard cases that several libraries get wrong, for every triangle
// kernel.
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/registry.h"
#include "kernels/registry.h"
#include "scenes/hard_cases/hard_cases.h"
#include "scenes/hard_cases/known_answers/promises.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boxwood {
namespace {

using T = Triangle<double>;

/// The kernel keeps its promise on what its own numbers make of the triangles.
template <class K> void expect_kept(const T& a, const T& b) {
    using Real = typename K::Real;
    const auto x = as<Real>(a), y = as<Real>(b);
    const bool truth = oracle::intersect(as<double>(x), as<double>(y));
    const Answer answer = K::intersect(x, y).answer;
    EXPECT_TRUE(is_kept(K::info.promise, answer, truth))
        << K::name << " says " << static_cast<int>(answer) << ", the truth is " << truth;
}

template <class F> void for_each_triangle_kernel(F f) {
    for_each_kernel<TriangleKernels, oracle::RationalTriangleKernels>(f);
}

/// Apart by far more than any rounding: even a kernel that promises nothing must not say yes.
void expect_apart(const T& a, const T& b, double distance) {
    for_each_triangle_kernel([&]<class K> {
        using Real = typename K::Real;
        expect_kept<K>(a, b);
        expect_kept<K>(b, a);
        EXPECT_NE(K::intersect(as<Real>(a), as<Real>(b)).answer, Answer::yes) << K::name;
    });
    for_each_kernel<DistanceKernels, oracle::RationalTriangleDistanceKernels>([&]<class K> {
        using Real = typename K::Real;
        const Distance d = K::distance(as<Real>(a), as<Real>(b));
        const double error = std::is_same_v<Real, float> ? 1e-4 : 1e-9;
        EXPECT_NEAR(d.distance, distance, error * distance) << K::name;
        if (K::info.promise == Promise::certified || K::info.promise == Promise::exact) {
            EXPECT_LE(d.lo, d.hi);
            EXPECT_LE(oracle::compare(d.lo, oracle::squared_distance(a, b)), 0) << K::name;
            EXPECT_GE(oracle::compare(d.hi, oracle::squared_distance(a, b)), 0) << K::name;
        }
    });
}

// Entry 1. An absolute epsilon on |n|^2 makes them touch.
TEST(KnownAnswers, TinyTriangles) {
    for (const double s : {1.8e-4, 1.7e-4, 1e-4, 1e-5, 1e-8}) {
        SCOPED_TRACE(s);
        const double h = s / 10;
        expect_apart({{0, 0, 0}, {s, 0, 0}, {0, s, 0}},
                     {{s / 4, s / 4, h}, {5 * s / 4, s / 4, h + s}, {s / 4, 5 * s / 4, h + s}}, h);
    }
}

// Entry 4. Two normals and nine products of edges do not separate them.
TEST(KnownAnswers, CoplanarAndDisjoint) {
    expect_apart({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{10, 10, 0}, {11, 10, 0}, {10, 11, 0}},
                 13.435028842544403);
}

// Entry 16. Parallel copies at every gap. The floats of the kernels of floats hold these too.
TEST(KnownAnswers, TranslatedCopies) {
    for (int k = 0; k <= 40; k += 4) {
        SCOPED_TRACE(k);
        const double gap = std::ldexp(1.0, -k);
        expect_apart({{0, 0, 0}, {3, 1, 0}, {1, 2, 0}}, {{0, 0, gap}, {3, 1, gap}, {1, 2, gap}},
                     gap);
    }
    for (const int k : {6, 15, 30, 44}) {
        HardCaseSpec spec;
        spec.k = k;
        const Cases cases = make_cases(*find_hard_case_family("translated_copies"), spec);
        for (const TrianglePairCase& c : std::get<std::vector<TrianglePairCase>>(cases))
            for_each_triangle_kernel([&]<class K> { expect_kept<K>(c.a, c.b); });
    }
}

// Entry 17. One rounding off a face or an edge.
TEST(KnownAnswers, WithinOneUlp) {
    const T face{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}};
    for (const double z : {std::nextafter(1.0, 0.0), 1.0, std::nextafter(1.0, 2.0)}) {
        const T standing{{1, 1, z}, {1, 2, 3}, {2, 1, 3}};
        for_each_triangle_kernel([&]<class K> {
            expect_kept<K>(face, standing);
            expect_kept<K>(standing, face);
        });
    }
    for (const char* family : {"within_one_ulp", "vertex_on_face", "edge_on_edge"}) {
        const Cases cases = make_cases(*find_hard_case_family(family), {});
        for (const TrianglePairCase& c : std::get<std::vector<TrianglePairCase>>(cases))
            for_each_triangle_kernel([&]<class K> { expect_kept<K>(c.a, c.b); });
    }
}

} // namespace
} // namespace boxwood
