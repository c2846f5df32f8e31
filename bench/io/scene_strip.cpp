#include "bench/io/scene_strip.h"

#include "bench/io/scene_picture.h"

#include <algorithm>
#include <span>

namespace boxwood::bench {
namespace {

std::string strip_of(const SceneFile& file, std::size_t n) {
    MovingScene scene(file, n);
    ScenePicture picture(scene, -1, MeshesAs::hulls);
    picture.add(scene, {});
    std::span<const std::uint32_t> changed;
    for (const std::size_t frame : {file.frames / 2, file.frames}) {
        if (scene.frame() >= frame)
            continue; // of a scene of a frame or two
        while (scene.frame() < frame)
            changed = scene.advance();
        picture.add(scene, changed);
    }
    return picture.svg();
}

} // namespace

std::string scene_strip(const SceneFile& file) {
    std::string svg;
    for (std::size_t n = std::min(file.n, max_in_strip); n > 0; n /= 2) {
        svg = strip_of(file, n);
        if (svg.size() <= max_strip_bytes)
            return svg;
    }
    return ""; // a mesh that no share of n makes smaller
}

} // namespace boxwood::bench
