// Entries of the list of hard cases that several libraries get wrong, for the box kernels.
#include "kernels/oracle/oracle.h"
#include "kernels/registry.h"
#include "scenes/hard_cases/hard_cases.h"
#include "scenes/hard_cases/known_answers/promises.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood {
namespace {

std::size_t n_overlaps(const std::vector<Aabb<float>>& boxes) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            n += overlaps(boxes[i], boxes[j]);
    return n;
}

template <class Real> Obb<Real> as(const Obb<double>& b) {
    return {Vec3<Real>(b.centre),
            {Vec3<Real>(b.axis[0]), Vec3<Real>(b.axis[1]), Vec3<Real>(b.axis[2])},
            Vec3<Real>(b.half)};
}

template <class Real> bool truth(const Obb<Real>& a, const Obb<Real>& b) {
    const auto pose = [](const Obb<Real>& box) {
        return std::array{Vec3<double>(box.centre), Vec3<double>(box.axis[0]),
                          Vec3<double>(box.axis[1]), Vec3<double>(box.axis[2])};
    };
    return oracle::boxes_touch(pose(a), Vec3<double>(a.half), pose(b), Vec3<double>(b.half));
}

template <class K> void expect_kept(const Obb<double>& a, const Obb<double>& b) {
    using Real = typename K::Real;
    const Obb<Real> x = as<Real>(a), y = as<Real>(b);
    const Answer answer = K::overlap(x, y).answer;
    EXPECT_TRUE(is_kept(K::info.promise, answer, truth(x, y)))
        << K::name << " says " << static_cast<int>(answer);
}

// Entry 2, as far as a question of yes or no goes: 219 separations along y and z.
TEST(KnownAnswers, BoxesApartAlongAnAxis) {
    Obb<double> a, b;
    a.half = b.half = {0.5, 0.5, 0.5};
    for (int i = 1; i <= 219; ++i)
        for (const int axis : {1, 2}) {
            b.centre = {0, 0, 0};
            b.centre[axis] = 1 + i / 64.0;
            for_each_kernel<ObbKernels>([&]<class K> {
                using Real = typename K::Real;
                EXPECT_EQ(K::overlap(as<Real>(a), as<Real>(b)).answer, Answer::no) << K::name;
            });
        }
}

// Entry 3. Two cubes of one pose, face to face up to rounding.
TEST(KnownAnswers, KissingBoxes) {
    const Vec3<double> rows[3]{
        {.96193976625564348026, .15401279915737359216, .22572537250328919556},
        {-.19134171618254486313, .96936494951283913579, .15401279915737359216},
        {-.19509032201612822033, -.19134171618254486313, .96193976625564348026}};
    const auto column = [&](int k) { return Vec3<double>{rows[0][k], rows[1][k], rows[2][k]}; };
    const Vec3<double> place{2, 0, 1.25};
    Obb<double> a{place, {column(0), column(1), column(2)}, {.25, .25, .25}}, b = a;
    b.centre = {2.0770063995786869349, .48468247475641951239, 1.1543291419087275962};
    const auto judge = [&] {
        for_each_kernel<ObbKernels>([&]<class K> {
            expect_kept<K>(a, b);
            expect_kept<K>(b, a);
        });
    };
    judge();
    for (const double size : {.01, .25, .5, 10., 1000.})
        for (const double gap : {0., 1e-16, -1e-16, 2.5e-16, -2.5e-16, 1e-15, -1e-15})
            for (int axis = 0; axis < 3; ++axis) {
                a.half = b.half = {size / 2, size / 2, size / 2};
                b.centre = place + (size + gap * std::max(1., size)) * column(axis);
                judge();
            }
    // By 1e-9 of their size the question is plain, and every kernel of doubles answers it.
    for (const double size : {.01, .25, .5, 10., 1000.})
        for (const double gap : {-1e-9, 1e-9}) {
            a.half = b.half = {size / 2, size / 2, size / 2};
            b.centre = place + (size + gap * std::max(1., size)) * column(1);
            for_each_kernel<ObbKernels>([&]<class K> {
                if constexpr (std::is_same_v<typename K::Real, double>) {
                    EXPECT_EQ(K::overlap(a, b).answer, gap < 0 ? Answer::yes : Answer::no)
                        << K::name;
                }
            });
        }
}

// Entry 10. Builders refuse such a box and name it (trees); as a pair it overlaps nothing.
TEST(KnownAnswers, NanAmongBoxes) {
    std::vector<Aabb<float>> boxes;
    for (int i = 0; i < 6; ++i) {
        const float x = 0.5f * static_cast<float>(i);
        boxes.push_back({{x - .3f, -.3f, -.3f}, {x + .3f, .3f, .3f}});
    }
    EXPECT_EQ(n_overlaps(boxes), 5u);
    boxes.back().min.x = boxes.back().max.x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(n_overlaps(boxes), 4u);
    EXPECT_FALSE(boxes.back().is_valid());
}

// Entry 14.
TEST(KnownAnswers, FourLinks) {
    std::vector<Aabb<float>> boxes;
    for (const float x : {0.f, .5f, 1.2f, 1.8f})
        boxes.push_back({{x - .32f, -.32f, -.32f}, {x + .32f, .32f, .32f}});
    EXPECT_EQ(n_overlaps(boxes), 2u);
}

// Entry 15. Closed boxes that touch overlap: an 8 x 8 x 8 lattice by faces, edges and corners.
TEST(KnownAnswers, TouchingBoxes) {
    HardCaseSpec spec;
    spec.n = 512;
    const Cases cases = make_cases(*find_hard_case_family("touching_grid"), spec);
    const auto& grid = std::get<BoxCases>(cases);
    const std::size_t faces = 3 * 7 * 8 * 8, edges = 3 * 2 * 7 * 7 * 8, corners = 4 * 7 * 7 * 7;
    EXPECT_EQ(grid.n_pairs, faces + edges + corners);
    EXPECT_EQ(n_overlaps(grid.boxes), grid.n_pairs);
}

} // namespace
} // namespace boxwood
