#pragma once

#include "trees/world/bodies/shape_pairs.h"

namespace boxwood::detail {

inline bool is_convex(const PosedShape& of) { return of.shape.shape_class() == ShapeClass::convex; }

/// How near to each other what is held may be for the grown shapes to touch.
inline double margin_of(const PosedShape& a, const PosedShape& b) {
    return (a.shape.radius() + a.margin) + (b.shape.radius() + b.margin);
}

/// Without margins, and solids as their surface: whether they are at most so far apart; at 0,
/// whether they touch.
Answer surfaces_within(const PosedShape& a, const PosedShape& b, double most, Work* work);

/// Without margins, and solids as their surface.
BodyDistance surface_distance(const PosedShape& a, const PosedShape& b,
                              const DistanceOptions& options, Work* work);

/// Of two whose surfaces do not touch: whether one lies in the other, which is a solid.
struct Inside {
    Answer answer = Answer::no;
    Vec3<double> point{}; ///< of the inner one, in the world
};
Inside inside(const PosedShape& a, const PosedShape& b);

} // namespace boxwood::detail
