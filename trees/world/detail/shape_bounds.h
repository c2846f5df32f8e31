#pragma once

#include "kernels/convex/shapes.h"
#include "trees/world/detail/obb_block.h"
#include "trees/world/pose.h"

#include <array>
#include <cstdint>
#include <span>

namespace boxwood::detail {

/// What a convex shape in a mesh's frame lies in: all that is at most `radius` from a box, from a
/// cylinder or cone along its third axis, from an ellipsoid, or from the hull of points; or below a
/// plane, or on it.
struct Envelope {
    enum class Form : std::uint8_t { box, cylinder, cone, ellipsoid, points, half_space, plane };

    /// Throws std::invalid_argument for a pose with a number that is not finite or a matrix off a
    /// rotation by more than 2^-12, and for a shape with a length that is negative or not finite,
    /// or that lies or reaches beyond 2^90.
    Envelope(const convex::Shape& shape, const Pose& pose);
    Envelope(const Envelope&) = delete; // `points` may be its own
    Envelope& operator=(const Envelope&) = delete;

    bool is_flat() const { return form == Form::half_space || form == Form::plane; }

    Form form = Form::box;
    Vec3<double> at;      ///< the middle; of half-spaces and planes the origin of their frame
    Vec3<double> axis[3]; ///< the axes of the shape's frame, in the mesh's
    double half[3]{};     ///< along them
    double radius = 0;
    /// In the shape's frame; `shift` takes them to the middle of their box.
    std::span<const Vec3<double>> points;
    Vec3<double> shift{};
    Vec3<double> normal{}; ///< of half-spaces and planes, of length 1, in the mesh's frame
    double offset = 0;     ///< along it, from `at`
    double size = 0;       ///< at least the sum of half, radius and |offset|
    /// A bound of what is `reach` around a point c may be off by
    /// relative_error (|c - at|_1 + reach + size) + own_error.
    double relative_error = 0, own_error = 0;

  private:
    std::array<Vec3<double>, 3> corners_{}; ///< of a triangle
};

/// Bounds from below of the distance of the envelope to eight boxes or triangles. One that is not
/// more than 0 says that the two may overlap, and is the less the deeper. In doubles, so that flat
/// faces that are parallel are told apart. Of boxes: the gaps along the axes of both, the roots of
/// the sums of their squares, and the gap along the way between the middles. Of triangles: along
/// the shape's axes, the triangle's normal and the way to its middle. Of cylinders and cones: along
/// the way from their axis, too. Lanes beyond `count` hold
/// some number.
void bound_boxes(const Envelope& shape, const ObbBlock& block, double (&bounds)[8]);
void bound_triangles(const Envelope& shape, const TriangleLeaf& leaf, double (&bounds)[8]);

} // namespace boxwood::detail
