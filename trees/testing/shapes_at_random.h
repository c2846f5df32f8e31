#pragma once

#include "kernels/convex/shapes.h"
#include "trees/testing/test_meshes.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace boxwood {

constexpr std::array<convex::ShapeKind, convex::shape_kinds> all_shape_kinds() {
    std::array<convex::ShapeKind, convex::shape_kinds> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i] = static_cast<convex::ShapeKind>(i);
    return all;
}

/// Shapes of every kind with lengths from 1/4 to 1; the points of the last hull are kept.
class ShapesAtRandom {
  public:
    explicit ShapesAtRandom(std::uint32_t seed) : random(seed) {}

    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    Vec3<double> vector(double size) {
        return {real(-size, size), real(-size, size), real(-size, size)};
    }
    Pose pose(double spread) { return random_pose(random, vector(spread)); }
    convex::Shape shape(convex::ShapeKind kind) {
        const auto size = [&] { return std::exp2(real(-2, 0)); };
        switch (kind) {
        case convex::ShapeKind::sphere:
            return convex::Sphere{size()};
        case convex::ShapeKind::box:
            return convex::Box{{size(), size(), size()}};
        case convex::ShapeKind::capsule:
            return convex::Capsule{size(), size()};
        case convex::ShapeKind::cylinder:
            return convex::Cylinder{size(), size()};
        case convex::ShapeKind::cone:
            return convex::Cone{size(), size()};
        case convex::ShapeKind::ellipsoid:
            return convex::Ellipsoid{{size(), size(), size()}};
        case convex::ShapeKind::half_space:
            return convex::HalfSpace{vector(1), real(-1, 1)};
        case convex::ShapeKind::plane:
            return convex::Plane{vector(1), real(-1, 1)};
        case convex::ShapeKind::hull:
            points_.assign(12, {});
            for (Vec3<double>& p : points_)
                p = vector(.7) + Vec3<double>{.3, 0, 0};
            return convex::Hull(points_);
        case convex::ShapeKind::triangle:
            break;
        }
        return convex::Triangle{vector(1), vector(1), vector(1)};
    }

    std::mt19937 random;

  private:
    std::vector<Vec3<double>> points_;
};

} // namespace boxwood
