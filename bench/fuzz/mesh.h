#pragma once

#include "bench/fuzz/scratch_file.h"
#include "scenes/meshes/mesh_file.h"

namespace boxwood::fuzz {

/// A mesh file is refused with its name, or gives a mesh that holds what it promises.
inline void read_mesh(const ScratchFile& file, Bytes bytes) {
    TriangleMesh mesh;
    try {
        mesh = load_mesh(file.holding(bytes));
    } catch (const std::runtime_error& error) {
        require(std::string_view(error.what()).starts_with("mesh " + file.path().string()),
                std::string("an error without the file's name: ") + error.what());
        return;
    }
    require(!mesh.triangles.empty(), "a mesh without triangles");
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle)
            require(vertex < mesh.vertices.size(), "a vertex index out of range");
    for (const Vec3<float>& vertex : mesh.vertices)
        require(is_finite(vertex), "a coordinate that is not finite");
}

} // namespace boxwood::fuzz
