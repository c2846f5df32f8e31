#pragma once

#include "kernels/primitives/rigid_transform.h"
#include "kernels/primitives/rotation.h"
#include "kernels/primitives/triangle.h"
#include "scenes/sampling/random.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace boxwood {

/// A kind of places of a copy of a mesh beside the mesh itself.
struct PoseKindEntry {
    std::string_view name, summary;
};
std::span<const PoseKindEntry> pose_kinds();

/// Throws std::invalid_argument, with a suggestion, unless `kind` is a name of `pose_kinds()`.
void check_pose_kind(std::string_view kind);

/// How a copy goes from one pose to the next while t goes from 0 to 1.
std::span<const PoseKindEntry> motion_paths();
/// Throws as check_pose_kind.
void check_motion_path(std::string_view path);

/// A rotation from four numbers, uniform over all: a point in the ball of four dimensions.
Rotation rotation_of(Draws& draws);

/// n poses of a copy of the mesh in the mesh's frame: any rotation, set off in any direction so far
/// that the two, seen along it, are a part of the mesh's width apart, or overlap by that. The same
/// bits on every machine; pose i depends on the mesh, the seed and i.
/// Throws std::invalid_argument for a mesh without triangles.
std::vector<RigidTransform<double>> make_poses(std::string_view kind, const TriangleMesh& mesh,
                                               std::size_t n, std::uint64_t seed);

/// What stands in such poses, if it is not the mesh as it is, else an empty mesh: the mesh scaled
/// from the middle of its box, rounded to floats.
TriangleMesh make_copy(std::string_view kind, const TriangleMesh& mesh);

} // namespace boxwood
