#include "kernels/predicates/rounded.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boxwood {
namespace {

static_assert(OrientationPredicates<Rounded<double>>);

struct NoSigns {
    using Real = double;
    static bool orient2d(Point2<double>, Point2<double>, Point2<double>);
};
static_assert(!OrientationPredicates<NoSigns>);

using Point = Vec3<double>;

TEST(Rounded, Signs) {
    const Point a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    EXPECT_EQ(Rounded<double>::orient3d(a, b, c, {0, 0, 1}), 1);
    EXPECT_EQ(Rounded<double>::orient3d(a, b, c, {5, 5, -1}), -1);
    EXPECT_EQ(Rounded<double>::orient3d(a, b, c, {5, -7, 0}), 0);
    EXPECT_EQ(Rounded<double>::orient3d(a, c, b, {0, 0, 1}), -1);
    EXPECT_EQ(Rounded<double>::orient2d({0, 0}, {1, 0}, {0, 1}), 1);
    EXPECT_EQ(Rounded<double>::orient2d({0, 0}, {0, 1}, {1, 0}), -1);
    EXPECT_EQ(Rounded<double>::orient2d({0, 0}, {1, 1}, {3, 3}), 0);
}

TEST(Rounded, NanIsUndecided) {
    EXPECT_EQ(Rounded<double>::orient2d({0, 0}, {1, std::nan("")}, {0, 1}), undecided);
    EXPECT_EQ(Rounded<double>::orient3d({0, 0, 0}, {1e200, 0, 1e200}, {0, 1e200, 1e200},
                                        {1e200, 1e200, 1e200}),
              undecided);
}

/// Why its promise is none: a point off the line by less than a rounding.
TEST(Rounded, IsWrongNearZero) {
    EXPECT_EQ(Rounded<double>::promise, Promise::none);
    const double tiny = 0x1p-540; // tiny^2 underflows
    EXPECT_EQ(Rounded<double>::orient2d({0, 0}, {tiny, 0}, {0, tiny}), 0);
}

} // namespace
} // namespace boxwood
