#pragma once

#include "kernels/primitives/rigid_transform.h"
#include "kernels/primitives/triangle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>

/// Closed convex shapes, each in a frame of its own and put into the world by a pose.
namespace boxwood::convex {

using Pose = RigidTransform<double>;
using Triangle = boxwood::Triangle<double>;

/// The ball of this radius around the origin.
struct Sphere {
    double radius = 0;
};
/// The points with |x|, |y|, |z| at most half.x, half.y, half.z.
struct Box {
    Vec3<double> half{};
};
/// All that is at most `radius` from the segment (0, 0, -half_length) to (0, 0, half_length).
struct Capsule {
    double radius = 0, half_length = 0;
};
/// Around the z axis, |z| <= half_length.
struct Cylinder {
    double radius = 0, half_length = 0;
};
/// Apex (0, 0, half_length); the base is the disk of this radius at z = -half_length.
struct Cone {
    double radius = 0, half_length = 0;
};
struct Ellipsoid {
    Vec3<double> radii{};
};
/// The points p with normal . p <= offset. The normal is not 0 and need not be of unit length.
struct HalfSpace {
    Vec3<double> normal{0, 0, 1};
    double offset = 0;
};
/// The points p with normal . p = offset. The normal is not 0 and need not be of unit length.
struct Plane {
    Vec3<double> normal{0, 0, 1};
    double offset = 0;
};

/// The convex hull of points that someone else keeps; not of none.
class Hull {
  public:
    constexpr Hull() = default;
    explicit Hull(std::span<const Vec3<double>> points) : points_(points) {
        if (!points.empty())
            reach_ = 0;
        for (const Vec3<double>& p : points) {
            const double r = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
            if (r > reach_ || std::isnan(r))
                reach_ = r; // and NaN it stays
        }
    }
    std::span<const Vec3<double>> points() const { return points_; }
    /// At least the greatest distance of a point from the origin; NaN if there is no point.
    double reach() const { return reach_; }

  private:
    std::span<const Vec3<double>> points_;
    double reach_ = std::numeric_limits<double>::quiet_NaN();
};

/// Every kind of shape, in this order everywhere.
enum class ShapeKind : std::uint8_t {
    sphere,
    box,
    capsule,
    cylinder,
    cone,
    ellipsoid,
    half_space,
    plane,
    hull,
    triangle
};
using ShapeTypes =
    std::tuple<Sphere, Box, Capsule, Cylinder, Cone, Ellipsoid, HalfSpace, Plane, Hull, Triangle>;
inline constexpr std::size_t shape_kinds = std::tuple_size_v<ShapeTypes>;

constexpr std::string_view to_string(ShapeKind kind) {
    constexpr std::string_view names[shape_kinds] = {
        "sphere",    "box",        "capsule", "cylinder", "cone",
        "ellipsoid", "half_space", "plane",   "hull",     "triangle"};
    return names[static_cast<std::size_t>(kind)];
}

/// The kind of a shape type.
template <class S, std::size_t i = 0> constexpr ShapeKind kind_of() {
    if constexpr (std::is_same_v<S, std::tuple_element_t<i, ShapeTypes>>)
        return static_cast<ShapeKind>(i);
    else
        return kind_of<S, i + 1>();
}

template <class S, class All = ShapeTypes> inline constexpr bool is_shape = false;
template <class S, class... T>
inline constexpr bool is_shape<S, std::tuple<T...>> = (std::is_same_v<S, T> || ...);
template <class S>
concept ConvexShape = is_shape<S>;
/// A shape that has a farthest point in every direction.
template <class S>
concept BoundedShape = ConvexShape<S> && !std::is_same_v<S, HalfSpace> && !std::is_same_v<S, Plane>;

/// A shape of any kind. As a std::variant, but where its shape lies is known without a branch.
class Shape {
  public:
    Shape() : Shape(Sphere{}) {}
    template <ConvexShape S> Shape(const S& s) : kind_(kind_of<S>()) {
        static_assert(std::is_trivially_copyable_v<S>);
        ::new (static_cast<void*>(storage_)) S(s);
    }

    ShapeKind kind() const { return kind_; }
    const void* address() const { return storage_; }
    /// Nothing if it is of another kind.
    template <ConvexShape S> const S* get_if() const {
        return kind_ == kind_of<S>() ? &get<S>() : nullptr;
    }
    /// f of the shape as what it is.
    template <class F> decltype(auto) visit(F&& f) const {
        switch (kind_) {
        case ShapeKind::sphere:
            return f(get<Sphere>());
        case ShapeKind::box:
            return f(get<Box>());
        case ShapeKind::capsule:
            return f(get<Capsule>());
        case ShapeKind::cylinder:
            return f(get<Cylinder>());
        case ShapeKind::cone:
            return f(get<Cone>());
        case ShapeKind::ellipsoid:
            return f(get<Ellipsoid>());
        case ShapeKind::half_space:
            return f(get<HalfSpace>());
        case ShapeKind::plane:
            return f(get<Plane>());
        case ShapeKind::hull:
            return f(get<Hull>());
        case ShapeKind::triangle:
            break;
        }
        return f(get<Triangle>());
    }

  private:
    template <class S> const S& get() const {
        return *std::launder(reinterpret_cast<const S*>(storage_));
    }

    alignas(double) std::byte storage_[sizeof(Triangle)];
    ShapeKind kind_;
};
static_assert(sizeof(Hull) <= sizeof(Triangle) && alignof(Hull) <= alignof(double));

} // namespace boxwood::convex
