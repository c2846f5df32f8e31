#pragma once

#include "kernels/kinematics/robot_description.h"
#include "kernels/primitives/triangle.h"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

/// What a URDF file says of a robot: links and joints in the order of the file, and the meshes of
/// its collision geometry, each read once, unscaled, in its own frame (LinkMesh::mesh is the
/// index).
struct UrdfRobot {
    RobotDescription description;
    std::vector<std::filesystem::path> mesh_files;
    std::vector<TriangleMesh> meshes;
};

/// Reads a URDF file by liburdfdom and its meshes by load_mesh. Package folders: see mesh_path.
/// Only what collides is read: neither visual geometry nor inertia, sensors or materials.
/// Understands <capsule radius= length=>, too (length without the round ends).
/// Throws std::runtime_error, "file:line: ..." where there is a line, for a file or mesh that is
/// missing or malformed, links that make no tree, numbers that are not finite, sizes below 0,
/// joints without limits, and planar and floating joints.
/// load: reads a mesh instead of load_mesh, and throws as it.
using LoadMesh = std::function<TriangleMesh(const std::filesystem::path&)>;
UrdfRobot read_urdf(const std::filesystem::path& file,
                    std::span<const std::filesystem::path> package_folders = {},
                    const LoadMesh& load = {});

/// The same from text, which comes from `file`; without meshes if `load_meshes` is false.
UrdfRobot parse_urdf(std::string_view text, const std::filesystem::path& file,
                     std::span<const std::filesystem::path> package_folders = {},
                     bool load_meshes = true, const LoadMesh& load = {});

} // namespace boxwood
