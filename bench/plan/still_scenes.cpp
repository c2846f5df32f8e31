#include "bench/plan/scenes.h"

#include "kernels/suggest.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {

std::vector<SceneSpec> still_scenes(const BlockReader& block, std::string_view mesh_is_for) {
    const std::vector<std::string> names = block.names("scene", names_of(scene_generators()));
    const std::string_view mesh = file_generator().name;
    const bool is_mesh = std::ranges::count(names, mesh) > 0;
    if (is_mesh && names.size() > 1)
        block.fail(fmt::format("the scene \"{}\" needs a [[cells]] block of its own", mesh));
    if (is_mesh && block.has("n"))
        block.fail(fmt::format("the scene \"{}\" takes no n: the size is that of its file", mesh),
                   "n");
    if (!mesh_is_for.empty())
        for (const std::string& name : names)
            if (!entry_named(name, scene_generators(), "scene").has_mesh)
                block.fail(
                    fmt::format("the scene \"{}\" has no triangles to {}", name, mesh_is_for));
    std::vector<std::size_t> sizes = block.sizes({SceneSpec{}.n});
    const std::vector<double> overlaps = block.numbers("overlaps", 0, 1e6, {SceneSpec{}.overlaps});
    if (is_mesh && block.inputs().mesh.empty())
        return {};
    if (is_mesh)
        sizes = {block.inputs().mesh_items};

    std::vector<SceneSpec> all;
    SceneSpec spec;
    spec.seed = block.inputs().seed;
    spec.file = is_mesh ? block.inputs().mesh : "";
    for (const std::string& name : names)
        for (const std::size_t n : sizes)
            for (const double mean : overlaps) {
                spec.generator = name;
                spec.n = n;
                spec.overlaps = mean;
                all.push_back(spec);
            }
    return all;
}

} // namespace boxwood::bench
