#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace boxwood {

/// The mesh file that a URDF file means. `name`: package://NAME/PATH (or model://), file://PATH, or
/// a path, if relative then from the folder of the URDF file.
/// A package NAME is looked for in `package_folders`, each of which holds packages or is the
/// package itself. If there are none, the folders from the URDF file upwards are searched for one
/// that is NAME or holds it, and then for one that holds `meshes`, if PATH goes through it.
/// Throws std::runtime_error that says where it was looked for, and how to fix it.
std::filesystem::path mesh_path(std::string_view name, const std::filesystem::path& urdf_file,
                                std::span<const std::filesystem::path> package_folders);

} // namespace boxwood
