/// Scene files: refused, or a scene; a small one is played for two frames.

#include "bench/fuzz/fuzz.h"
#include "scenes/moving/moving_scene.h"

namespace boxwood::fuzz {
namespace {

/// Whether few bodies and triangles come of it.
bool is_small(const SceneFile& scene) {
    for (const BodyGroup& group : scene.groups)
        if (group.n > 200 || group.triangles > 200)
            return false;
    return scene.n <= 200 && scene.groups.size() <= 8;
}

} // namespace

void scene_toml(Bytes bytes) {
    try {
        SceneFile scene = parse_scene_file(text_of(bytes), "fuzz.toml");
        if (!is_small(scene))
            return;
        MovingScene moving(std::move(scene));
        for (int frame = 0; frame < 2; ++frame)
            moving.advance();
    } catch (const std::invalid_argument&) {
    }
}

} // namespace boxwood::fuzz
