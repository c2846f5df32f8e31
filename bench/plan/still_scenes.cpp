#include "bench/plan/scenes.h"

#include "kernels/suggest.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {

std::vector<SceneSpec> still_scenes(const BlockReader& block, std::string_view mesh_is_for) {
    const std::vector<std::string> names = block.names("scene", names_of(scene_generators()));
    const auto own = std::ranges::find_if(names, [](const std::string& name) {
        return entry_named(name, scene_generators(), "scene").reads_file;
    });
    const bool is_own = own != names.end();
    if (is_own && names.size() > 1)
        block.fail(fmt::format("the scene \"{}\" needs a [[cells]] block of its own", *own));
    if (is_own && block.has("n"))
        block.fail(fmt::format("the scene \"{}\" takes no n: the size is that of its file", *own),
                   "n");
    if (!mesh_is_for.empty())
        for (const std::string& name : names)
            if (!entry_named(name, scene_generators(), "scene").has_mesh)
                block.fail(
                    fmt::format("the scene \"{}\" has no triangles to {}", name, mesh_is_for));
    const std::vector<std::size_t> sizes = block.sizes({SceneSpec{}.n});
    const std::vector<double> overlaps = block.numbers("overlaps", 0, 1e6, {SceneSpec{}.overlaps});

    std::vector<SceneSpec> all;
    SceneSpec spec;
    spec.seed = block.inputs().seed;
    if (is_own) {
        spec.generator = *own;
        for (const OwnScene& scene : block.inputs().own)
            if (scene.generator == *own) {
                spec.file = scene.file;
                spec.n = scene.items;
                all.push_back(spec);
            }
        return all;
    }
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
