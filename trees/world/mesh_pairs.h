#pragma once

#include "trees/inspect/work.h"
#include "trees/queries/sinks.h"
#include "trees/world/mesh_tree.h"
#include "trees/world/pose.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace boxwood {

/// Questions about two meshes. B stands at `b_in_a` in A's frame (relative_pose); its corners are
/// moved there in doubles, rounded once, and the answers are exact or certified for those corners.
/// Throws std::invalid_argument for a pose with a number that is not finite or beyond 2^62, or a
/// matrix off orthonormal by more than 2^-12 (checked_pose mends it).
/// Touching counts. A mesh is its surface: what lies inside one without touching it is apart.
/// `work`, if given, is added to.

/// Whether they share a point. Stops at the first pair of triangles that do.
bool collide(const MeshTree& a, const MeshTree& b, const Pose& b_in_a, Work* work = nullptr);

/// The pairs of triangles (of A, of B) that share a point, up to `limit` of them, in an order that
/// depends on the meshes and the pose alone.
std::vector<Pair> touching_triangles(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                                     std::size_t limit = std::numeric_limits<std::size_t>::max(),
                                     Work* work = nullptr);
/// Into memory of one's own, which is cleared first.
void touching_triangles(const MeshTree& a, const MeshTree& b, const Pose& b_in_a, std::size_t limit,
                        std::vector<Pair>& pairs, Work* work = nullptr);

/// All of them by several threads, in an order that does not depend on how many.
std::vector<Pair> touching_triangles(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                                     const Executor& executor);

/// The pairs of triangles (of A, of B) that are at most `reach` apart, or within rounding of that,
/// up to `limit` of them, in an order that depends on the meshes, the pose and the reach alone.
/// Throws std::invalid_argument for a reach that is negative, NaN or beyond 2^100.
std::vector<Pair> near_triangles(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                                 double reach,
                                 std::size_t limit = std::numeric_limits<std::size_t>::max(),
                                 Work* work = nullptr);

struct DistanceOptions {
    /// The answer may be farther than the least distance: hi <= (lo + absolute) / (1 - relative),
    /// up to 2^-32 of it.
    double relative = 0, absolute = 0;
    /// A pair of triangles that is likely to be near, as that of the last answer along a motion.
    std::optional<Pair> start = std::nullopt;
    /// Nothing at this distance or beyond is looked for; then lo is at least this, and hi infinite.
    double limit = std::numeric_limits<double>::infinity();
};

/// The least distance of two meshes, scene units: lo <= distance <= hi, and the true one lies
/// between lo and hi, hi - lo <= 2^-32 hi + 2^-1073 where no tolerance was given. 0, and lo = hi =
/// 0, exactly where they touch. Of one that is empty, infinity.
struct MeshDistance {
    double distance = std::numeric_limits<double>::infinity();
    double lo = std::numeric_limits<double>::infinity();
    double hi = std::numeric_limits<double>::infinity();
    Vec3<double> point_a{}, point_b{}; ///< where it is taken, in A's frame
    Pair triangles{~0u, ~0u};          ///< of A, of B; ~0u: none

    bool found() const { return triangles.a != ~0u; }
};
MeshDistance distance(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                      const DistanceOptions& options = {}, Work* work = nullptr);
/// The same without its certificate, to show what that costs: pairs of triangles stand as plain
/// doubles measure them. lo = hi = distance, beside the tolerances usually off by some 2^-50 of the
/// size of both, by 2^-36 where edges are nearly parallel, and nothing is promised: two that touch
/// may be said to be a little apart.
MeshDistance plain_distance(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                            const DistanceOptions& options = {}, Work* work = nullptr);

/// Whether they are at most `tolerance` apart, certain but within 2^-32 of it: then lo and hi lie
/// on both sides of the tolerance, and `within` is true.
struct MeshWithin {
    bool within = false;
    double lo = 0, hi = std::numeric_limits<double>::infinity(); ///< of the least distance
};
MeshWithin within(const MeshTree& a, const MeshTree& b, const Pose& b_in_a, double tolerance,
                  Work* work = nullptr);

} // namespace boxwood
