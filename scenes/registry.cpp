#include "scenes/registry.h"

#include "kernels/suggest.h"

#include <algorithm>
#include <stdexcept>

#define BOXWOOD_SCENES(X)                                                                          \
    X(uniform)                                                                                     \
    X(clusters)                                                                                    \
    X(bars)                                                                                        \
    X(planks)                                                                                      \
    X(needles)                                                                                     \
    X(cubes)                                                                                       \
    X(assorted)                                                                                    \
    X(log_normal)                                                                                  \
    X(cloud_in_room)                                                                               \
    X(layer)                                                                                       \
    X(lattice)                                                                                     \
    X(point_cloud)                                                                                 \
    X(sphere_mesh)                                                                                 \
    X(smooth_sphere)                                                                               \
    X(scan_mesh)                                                                                   \
    X(triangle_soup)                                                                               \
    X(sliver_mesh)                                                                                 \
    X(cloth)                                                                                       \
    X(wavy_sheet)                                                                                  \
    X(four_link)                                                                                   \
    X(chain)                                                                                       \
    X(mesh)                                                                                        \
    X(boxes)

namespace boxwood {

#define BOXWOOD_DECLARE(name) SceneEntry name##_scene();
BOXWOOD_SCENES(BOXWOOD_DECLARE)
#undef BOXWOOD_DECLARE

std::span<const SceneEntry> scene_generators() {
#define BOXWOOD_ROW(name) name##_scene(),
    static const SceneEntry entries[] = {BOXWOOD_SCENES(BOXWOOD_ROW)};
#undef BOXWOOD_ROW
    return entries;
}

const SceneEntry& scene_generator(std::string_view name) {
    for (const SceneEntry& entry : scene_generators())
        if (entry.name == name)
            return entry;
    std::vector<std::string_view> known = names_of(scene_generators());
    for (const HardCaseFamily& family : hard_case_families())
        known.push_back(family.name);
    throw std::invalid_argument(unknown_name("scene", name, known));
}

} // namespace boxwood
