#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/exact_vector.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace boxwood::oracle {
namespace {

struct Box {
    std::array<Vec3<double>, 4> pose; // centre and axes
    Vec3<double> half;

    Vec3<double> corner(int k) const {
        Vec3<double> p = pose[0];
        for (int i = 0; i < 3; ++i)
            p = p + pose[static_cast<std::size_t>(i + 1)] * ((k >> i) & 1 ? half[i] : -half[i]);
        return p;
    }
    std::vector<Triangle<double>> surface() const {
        std::vector<Triangle<double>> all;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                const int i = 1 << ((axis + 1) % 3), j = 1 << ((axis + 2) % 3), k = side << axis;
                all.push_back({corner(k), corner(k + i), corner(k + j)});
                all.push_back({corner(k + i + j), corner(k + i), corner(k + j)});
            }
        return all;
    }
    /// p in the box, if that has volume: by Cramer's rule, exact on small whole numbers.
    bool holds(Vec3<double> p) const {
        const Vec3<double> x = pose[1], y = pose[2], z = pose[3], q = p - pose[0];
        const double det = dot(cross(x, y), z);
        return std::abs(dot(cross(q, y), z)) <= std::abs(det) * half.x &&
               std::abs(dot(cross(x, q), z)) <= std::abs(det) * half.y &&
               std::abs(dot(cross(x, y), q)) <= std::abs(det) * half.z;
    }
    bool is_solid() const {
        return dot(cross(pose[1], pose[2]), pose[3]) != 0 && half.x * half.y * half.z != 0;
    }
};

bool touch(const Box& a, const Box& b) { return boxes_touch(a.pose, a.half, b.pose, b.half); }

bool surfaces_meet(const Box& a, const Box& b) {
    for (const auto& s : a.surface())
        for (const auto& t : b.surface())
            if (intersect(s, t))
                return true;
    return false;
}

class Random {
  public:
    double whole(int max) { // -max .. max
        return static_cast<double>(std::uniform_int_distribution<int>(-max, max)(bits_));
    }
    Vec3<double> vector(int max) { return {whole(max), whole(max), whole(max)}; }
    Vec3<double> half(int max) {
        const Vec3<double> v = vector(max);
        return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
    }

  private:
    std::mt19937_64 bits_{5};
};

// Any axes, perhaps parallel or zero, and half sizes of 0 too: all boxes stand on whole numbers.
TEST(OracleBoxes, TouchAsTheirSurfacesDo) {
    Random random;
    int touching = 0, apart = 0, nested = 0, flat = 0;
    for (int i = 0; i < 600; ++i) {
        const auto box = [&](int max) {
            return Box{{random.vector(6), random.vector(1), random.vector(1), random.vector(1)},
                       random.half(max)};
        };
        const Box a = box(2), b = box(i % 2 ? 3 : 9);
        const bool meet = surfaces_meet(a, b);
        const bool inside =
            (b.is_solid() && b.holds(a.pose[0])) || (a.is_solid() && a.holds(b.pose[0]));
        touching += meet;
        nested += inside && !meet;
        apart += !inside && !meet;
        flat += meet && !a.is_solid() && !b.is_solid();
        ASSERT_EQ(touch(a, b), meet || inside) << i;
        ASSERT_EQ(touch(b, a), meet || inside) << i;
    }
    EXPECT_GT(touching, 100);
    EXPECT_GT(apart, 100);
    EXPECT_GT(nested, 2);
    EXPECT_GT(flat, 20);
}

TEST(OracleBoxes, UnalignedScalesAndThinGaps) {
    const std::array<Vec3<double>, 4> here{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (const double size : {1.0, 0x1p-1000, 0x1p+900}) {
        auto there = here;
        there[0] = {2 * size, 0.5 * size, 0};
        const Vec3<double> half{size, size, 0};
        EXPECT_TRUE(boxes_touch(here, half, there, half));
        there[0].x = std::nextafter(2 * size, 1e300);
        EXPECT_FALSE(boxes_touch(here, half, there, half));
        there[1].x = 1 + 0x1p-51; // an axis a little longer reaches across
        EXPECT_TRUE(boxes_touch(here, half, there, half));
    }
}

TEST(OracleBoxes, ImageHoldsAllCornersAndNoMore) {
    Random random;
    for (int i = 0; i < 500; ++i) {
        const RigidTransform<double> t{{random.vector(9), random.vector(9), random.vector(9)},
                                       random.vector(9)};
        Aabb<double> box, expected;
        box.extend(random.vector(9));
        box.extend(random.vector(9));
        for (int k = 0; k < 8; ++k)
            expected.extend(t({k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                               k & 4 ? box.max.z : box.min.z}));
        const RationalBox got = image(t, box);
        for (int k = 0; k < 3; ++k) {
            ASSERT_EQ(got.min[static_cast<std::size_t>(k)], exact(expected.min[k]));
            ASSERT_EQ(got.max[static_cast<std::size_t>(k)], exact(expected.max[k]));
        }
    }
}

} // namespace
} // namespace boxwood::oracle
