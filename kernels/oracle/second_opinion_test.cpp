// The second oracle against known answers and wrong claims; scenes/hard_cases/truth_test.cpp holds
// it against the first one on every family of hard cases.
#include "kernels/oracle/second_opinion.h"

#include "kernels/oracle/rational.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace boxwood::oracle {
namespace {

using Points = std::array<Vec3<double>, 4>;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(SecondOpinion, KnownDistances) {
    const auto squared = [](const std::vector<Vec3<double>>& a,
                            const std::vector<Vec3<double>>& b) {
        return second_opinion::squared_distance(a, b);
    };
    EXPECT_EQ(squared({{1, 2, 3}}, {{1, 2, 3}}), 0);
    EXPECT_EQ(squared({{0, 0, 0}}, {{1, 1, 0}, {1, -1, 0}}), 1);
    EXPECT_EQ(squared({{0, 0, 0}}, {{1, 0, 0}, {0, 1, 0}}), mpq_class(1, 2));
    EXPECT_EQ(squared({{0, 0, 0}}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), mpq_class(1, 3));
    EXPECT_EQ(squared({{-1, 0, 0}, {1, 0, 0}}, {{0, -1, 2}, {0, 1, 2}}), 4);
    EXPECT_EQ(squared({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{1, 1, -1}, {1, 1, 1}}), 0);
    EXPECT_EQ(squared({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{10, 10, 0}, {11, 10, 0}, {10, 11, 0}}),
              mpq_class(361, 2));
}

/// A vertex falls onto a face at rest: at t = 1/3, which is no double.
TEST(SecondOpinion, RefusesWrongTimes) {
    const Points start{{{.25, .25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    Points end = start;
    end[0].z = -2;
    const LinearMotion motion{start, end};
    const auto confirms = [&](Answer answer, double t_free, double t_hit) {
        return second_opinion::confirms_vertex_face(motion, {answer, t_free, t_hit, 0});
    };
    const double above = std::nextafter(1. / 3, 1), below = std::nextafter(1. / 3, 0);
    EXPECT_TRUE(confirms(Answer::yes, 1. / 3, above)); // 1. / 3 is less than 1/3
    EXPECT_FALSE(confirms(Answer::yes, below, 1. / 3));
    EXPECT_FALSE(confirms(Answer::yes, above, std::nextafter(above, 1)));
    EXPECT_FALSE(confirms(Answer::yes, 1. / 3, 1. / 3));
    EXPECT_FALSE(confirms(Answer::yes, 0, 1));
    EXPECT_FALSE(confirms(Answer::no, 1, infinity));
    EXPECT_FALSE(confirms(Answer::maybe, 1. / 3, above));

    LinearMotion past = motion; // beside the face
    past.start[0].x = past.end[0].x = 1;
    EXPECT_TRUE(second_opinion::confirms_vertex_face(past, {}));
    EXPECT_FALSE(second_opinion::confirms_vertex_face(past, {Answer::yes, 1. / 3, above, 0}));
}

TEST(SecondOpinion, ATimeThatIsADouble) {
    // One end of the edge 2 3 falls past the edge 0 1: they cross at t = 1/2.
    const Points start{{{-8, 0, 0}, {8, 0, 0}, {-1, -1, 1}, {-1, 1, 1}}};
    const Points end{{{-8, 0, 0}, {8, 0, 0}, {-1, -1, -3}, {-1, 1, 1}}};
    const LinearMotion motion{start, end};
    const Impact first = ExactContinuous().edge_edge(motion);
    ASSERT_EQ(first.answer, Answer::yes);
    EXPECT_EQ(first.t_hit, .5);
    EXPECT_TRUE(second_opinion::confirms_edge_edge(motion, first));
    for (const double t : {.25, .75, 1.})
        EXPECT_FALSE(second_opinion::confirms_edge_edge(motion, {Answer::yes, t, t, 0})) << t;
    EXPECT_FALSE(second_opinion::confirms_edge_edge(motion, {}));
}

TEST(SecondOpinion, MotionsOfSmallIntegers) {
    std::mt19937 bits(5);
    int touches = 0;
    for (int i = 0; i < 4000; ++i) {
        const int size = 1 + i % 4, flat = i % 3; // a third of them in one plane all the time
        LinearMotion motion;
        for (Points* points : {&motion.start, &motion.end})
            for (Vec3<double>& p : *points) {
                const auto draw = [&] { return std::uniform_int_distribution(-size, size)(bits); };
                p = Vec3<double>(draw(), draw(), flat == 0 ? 0 : draw());
            }
        const ExactContinuous exact;
        const Impact face = exact.vertex_face(motion), edge = exact.edge_edge(motion);
        ASSERT_TRUE(second_opinion::confirms_vertex_face(motion, face)) << i;
        ASSERT_TRUE(second_opinion::confirms_edge_edge(motion, edge)) << i;
        for (const Impact& impact : {face, edge})
            touches += impact.answer == Answer::yes;
        const Impact flipped_face =
            face.answer == Answer::yes ? Impact{} : Impact{Answer::yes, 0, 0, 0};
        ASSERT_FALSE(second_opinion::confirms_vertex_face(motion, flipped_face)) << i;
    }
    EXPECT_GT(touches, 1000);
}

TEST(SecondOpinion, Rays) {
    const Triangle<float> t{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const auto hit = second_opinion::ray_triangle({{.25f, .5f, -1}, {0, 0, 2}}, t);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, mpq_class(1, 2));
    EXPECT_EQ(hit->u, mpq_class(1, 4));
    EXPECT_EQ(hit->v, mpq_class(1, 2));
    EXPECT_FALSE(second_opinion::ray_triangle({{.75f, .5f, -1}, {0, 0, 2}}, t));
    EXPECT_FALSE(second_opinion::ray_triangle({{-1, .5f, 0}, {1, 0, 0}}, t)); // in its plane
    EXPECT_FALSE(second_opinion::ray_triangle({{.25f, .5f, -1}, {0, 0, 2}, 0, .25f}, t));
}

} // namespace
} // namespace boxwood::oracle
