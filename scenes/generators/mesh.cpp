#include "scenes/meshes/mesh_file.h"
#include "scenes/registry.h"

#include <fmt/format.h>

#include <stdexcept>

namespace boxwood {
namespace {

/// The user's own mesh.
struct Mesh {
    static constexpr std::string_view name = "mesh";
    static constexpr std::string_view human_name = "mesh {file}";
    static constexpr std::string_view summary =
        "the triangles of a file: OBJ, PLY, STL, ... (n, seed and overlaps unused)";
    static constexpr bool has_mesh = true, uses_overlaps = false;

    static Scene generate(const SceneSpec& spec) {
        Scene scene;
        scene.mesh = load_mesh(spec.file);
        scene.params_json = fmt::format(R"({{"vertices":{}}})", scene.mesh.vertices.size());
        return scene;
    }
};

} // namespace

SceneEntry mesh_scene() {
    SceneEntry entry = scene_entry<Mesh>();
    entry.reads_file = true;
    return entry;
}

} // namespace boxwood
