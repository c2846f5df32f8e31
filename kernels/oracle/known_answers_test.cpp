// Hard cases whose answers are known: several libraries get them wrong.
#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/exact_vector.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boxwood::oracle {
namespace {

using T = Triangle<double>;

TEST(OracleKnownAnswers, TinyTriangles) {
    for (const double s : {1.8e-4, 1.7e-4, 1e-4, 1e-5, 1e-300}) {
        const double h = s / 10;
        const T a{{0, 0, 0}, {s, 0, 0}, {0, s, 0}};
        const T b{{s / 4, s / 4, h}, {5 * s / 4, s / 4, h + s}, {s / 4, 5 * s / 4, h + s}};
        EXPECT_FALSE(intersect(a, b));
        EXPECT_EQ(nearest_sqrt(squared_distance(a, b)), h);
    }
}

TEST(OracleKnownAnswers, CoplanarAndDisjoint) {
    const T a{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, b{{10, 10, 0}, {11, 10, 0}, {10, 11, 0}};
    EXPECT_FALSE(intersect(a, b));
    EXPECT_EQ(nearest_sqrt(squared_distance(a, b)), 13.435028842544403);
}

TEST(OracleKnownAnswers, DegenerateTriangles) {
    const T face{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    const T point{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}, above{{1, 1, 2}, {1, 1, 2}, {1, 1, 2}};
    const T needle{{1, 1, -1}, {1, 1, 3}, {1, 1, 1}}, beside{{3, 3, -1}, {3, 3, 3}, {3, 3, 1}};
    EXPECT_TRUE(intersect(face, point));
    EXPECT_TRUE(intersect(point, point));
    EXPECT_FALSE(intersect(face, above));
    EXPECT_TRUE(intersect(face, needle));
    EXPECT_TRUE(intersect(above, needle));
    EXPECT_FALSE(intersect(face, beside));
    EXPECT_EQ(squared_distance(face, above), 4);
    EXPECT_EQ(squared_distance(face, beside), 2);
    EXPECT_EQ(squared_distance(needle, beside), 8);
    EXPECT_EQ(squared_distance(above, beside), 8);
}

// Parallel copies: the gap along the normal, at every gap.
TEST(OracleKnownAnswers, TranslatedCopies) {
    for (int k = 0; k <= 1074; k += 179) {
        const double gap = std::ldexp(1.0, -k);
        const T a{{0, 0, 0}, {3, 1, 0}, {1, 2, 0}}, b{{0, 0, gap}, {3, 1, gap}, {1, 2, gap}};
        EXPECT_FALSE(intersect(a, b));
        EXPECT_EQ(nearest_sqrt(squared_distance(a, b)), gap);
    }
}

TEST(OracleKnownAnswers, WithinOneUlp) {
    const T face{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}};
    const double above = std::nextafter(1.0, 2.0), below = std::nextafter(1.0, 0.0);
    const auto standing = [](double z) { return T{{1, 1, z}, {1, 2, 3}, {2, 1, 3}}; };
    EXPECT_TRUE(intersect(face, standing(1)));
    EXPECT_TRUE(intersect(face, standing(below)));
    EXPECT_FALSE(intersect(face, standing(above)));
    EXPECT_EQ(nearest_sqrt(squared_distance(face, standing(above))), 0x1p-52);
}

TEST(OracleKnownAnswers, DistanceOfBoxFaces) {
    // Box(1,1,1) at the origin and at (0,4,0), by the faces that look at each other.
    const T low[2]{{{-.5, .5, -.5}, {.5, .5, -.5}, {.5, .5, .5}},
                   {{-.5, .5, -.5}, {-.5, .5, .5}, {.5, .5, .5}}};
    const T high[2]{{{-.5, 3.5, -.5}, {.5, 3.5, -.5}, {.5, 3.5, .5}},
                    {{-.5, 3.5, -.5}, {-.5, 3.5, .5}, {.5, 3.5, .5}}};
    for (const T& a : low)
        for (const T& b : high)
            EXPECT_EQ(squared_distance(a, b), 9);
}

// Two boxes of half size .25 that kiss to within 1e-12; apart or deep by more, it shows.
TEST(OracleKnownAnswers, KissingBoxes) {
    const Vec3<double> rows[3]{
        {.96193976625564348026, .15401279915737359216, .22572537250328919556},
        {-.19134171618254486313, .96936494951283913579, .15401279915737359216},
        {-.19509032201612822033, -.19134171618254486313, .96193976625564348026}};
    const auto column = [&](int k) { return Vec3<double>{rows[0][k], rows[1][k], rows[2][k]}; };
    const Vec3<double> half{.25, .25, .25}, along = column(0);
    const Vec3<double> at_a{2.0770063995786869349, .48468247475641951239, 1.1543291419087275962},
        at_b{2, 0, 1.25};
    const Vec3<double> out = column(1); // at_a - at_b is half of it
    for (const double gap : {-1e-12, 1e-12}) {
        const std::array<Vec3<double>, 4> a{at_a + out * gap, along, out, column(2)},
            b{at_b, along, out, column(2)};
        EXPECT_EQ(boxes_touch(a, half, b, half), gap < 0);
    }
}

} // namespace
} // namespace boxwood::oracle
