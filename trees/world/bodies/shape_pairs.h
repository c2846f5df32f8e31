#pragma once

#include "kernels/decision.h"
#include "trees/inspect/work.h"
#include "trees/world/bodies/body_shape.h"
#include "trees/world/continuous.h"
#include "trees/world/mesh_contacts.h"
#include "trees/world/mesh_pairs.h"
#include "trees/world/motion.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace boxwood {

/// A shape where it stands in the world, and all that is at most `margin` from it (and the radius
/// of points): so grown it is what the questions below are about. The pose is as checked_pose gives
/// it, the margin at least 0.
struct PosedShape {
    const BodyShape& shape;
    Pose pose{};
    double margin = 0;
};

/// Questions about two posed shapes of any class. The margin of a pair is the sum of both, rounded.
/// Sets are closed. Of meshes they are exact or certified as mesh_pairs.h says, of convex shapes
/// certified as kernels/convex/ says: `maybe` is within rounding. What swaps sides may be rounded
/// another way. `work`, if given, is added to.

/// Whether they share a point.
Answer collide(const PosedShape& a, const PosedShape& b, Work* work = nullptr);

/// Whether they are at most `tolerance` apart. Throws std::invalid_argument for one below 0 or NaN.
Answer within(const PosedShape& a, const PosedShape& b, double tolerance, Work* work = nullptr);

/// How far two bodies are apart, scene units: lo <= distance <= hi, and the true distance lies
/// between lo and hi. 0 where they overlap; all three infinite, or lo at least the limit, where
/// nothing is nearer than that or one is empty.
struct BodyDistance {
    Pair bodies{}; ///< where they are of a World
    double distance = std::numeric_limits<double>::infinity();
    double lo = std::numeric_limits<double>::infinity();
    double hi = std::numeric_limits<double>::infinity();
    Vec3<double> point_a{}, point_b{}; ///< in the world, on the shapes without margins
    Pair parts{~0u, ~0u};              ///< triangles or points; ~0u of what has none

    bool found() const { return hi < std::numeric_limits<double>::infinity(); }
};
/// options.relative is of the distance without margins; start and limit have no effect on two
/// convex shapes. Throws std::invalid_argument for a share that is not from 0 to below 1 and for
/// other numbers that are negative or NaN.
BodyDistance distance(const PosedShape& a, const PosedShape& b, const DistanceOptions& options = {},
                      Work* work = nullptr);

/// As `distance`, of convex shapes and solids; below 0 they overlap and -distance is how
/// deep: of convex shapes the least way that parts them (and tolerance has no effect), of two
/// solids, or of one and a convex shape, the farthest that a point of one's surface inside the
/// other is from the other's, where hi - lo is at most `tolerance`, or as solid.h says of 0.
/// Margins are added to either. Points of two solids that overlap are one. Throws
/// std::invalid_argument where one is a surface or points, and for a tolerance below 0 or NaN.
BodyDistance signed_distance(const PosedShape& a, const PosedShape& b, double tolerance = 0,
                             Work* work = nullptr);

/// A place where two bodies meet. By its depth along the normal b has to move for the two parts
/// there only to touch.
struct BodyContact {
    Pair bodies{};                ///< where they are of a World
    Vec3<double> point{};         ///< in the world; midway between the two surfaces without margins
    Vec3<double> normal{0, 0, 1}; ///< of length 1, in the world, from a to b
    double depth = 0;             ///< scene units; infinite for two flats that no motion parts
    Pair parts{~0u, ~0u};         ///< triangles or points; ~0u of what has none
};
/// The deepest first: of meshes one of each pair of parts that touch or, where none does, that are
/// near enough for the margins, 65,536 of them at most and the nearest (options.margin has no
/// effect); of convex shapes at most four. (What is near where others touch may be on either side
/// of a surface.) Where a body lies within a solid whose surface it does not touch, one at the
/// nearest points, whose depth is at most the true one. None, perhaps, where `collide` says maybe.
std::vector<BodyContact> contacts(const PosedShape& a, const PosedShape& b,
                                  const ContactOptions& options = {}, Work* work = nullptr);

/// A shape that goes from one pose to another while t goes from 0 to 1.
struct MovingShape {
    const BodyShape& shape;
    Pose from{}, to{};
    MotionPath path = MotionPath::linear;
    double margin = 0;
};
/// When they first share a point: FirstContact, whose triangles are parts. `maybe` also for a
/// half-space or plane that turns and meets what is convex.
FirstContact first_contact(const MovingShape& a, const MovingShape& b,
                           const ContinuousOptions& options = {}, Work* work = nullptr);

} // namespace boxwood
