#pragma once

#include "kernels/convex/shapes.h"
#include "trees/world/detail/obb_block.h"
#include "trees/world/pose.h"

#include <cstdint>

namespace boxwood::detail {

/// What a convex shape in a mesh's frame lies in: all that is at most `radius` from a box, from a
/// solid round about its third axis, or from an ellipsoid; or below a plane, or on it. Of spheres,
/// boxes, capsules, cylinders, ellipsoids, half-spaces and planes it is the shape itself.
struct Envelope {
    enum class Form : std::uint8_t { box, round, ellipsoid, half_space, plane };

    /// Throws std::invalid_argument for a pose with a number that is not finite or a matrix off a
    /// rotation by more than 2^-12, and for a shape with a length that is negative or not finite,
    /// or that lies or reaches beyond 2^90.
    Envelope(const convex::Shape& shape, const Pose& pose);

    bool is_flat() const { return form == Form::half_space || form == Form::plane; }

    Form form = Form::box;
    Vec3<double> at;      ///< the middle; of half-spaces and planes the origin of their frame
    Vec3<double> axis[3]; ///< the axes of the shape's frame, in the mesh's
    double half[3]{};     ///< along them
    double radius = 0;
    Vec3<double> normal{}; ///< of half-spaces and planes, of length 1, in the mesh's frame
    double offset = 0;     ///< along it, from `at`
    double size = 0;       ///< at least the sum of half, radius and |offset|
    /// A bound of what is `reach` around a point c may be off by
    /// relative_error (|c - at|_1 + reach + size) + own_error.
    double relative_error = 0, own_error = 0;
};

/// Bounds from below of the distance of the envelope to eight boxes or triangles. One that is not
/// more than 0 says that the two may overlap, and is the less the deeper. In doubles, so that flat
/// faces that are parallel are told apart. Of boxes: the gaps along the axes of both, the roots of
/// the sums of their squares, and the gap along the way between the middles. Of triangles: along
/// the shape's axes, the triangle's normal and the way to its middle. Lanes beyond `count` hold
/// some number.
void bound_boxes(const Envelope& shape, const ObbBlock& block, double (&bounds)[8]);
void bound_triangles(const Envelope& shape, const TriangleLeaf& leaf, double (&bounds)[8]);

} // namespace boxwood::detail
