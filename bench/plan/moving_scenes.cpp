#include "bench/plan/scenes.h"

#include "kernels/suggest.h"
#include "scenes/effects/effect_scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

bool is_generator(std::string_view name) {
    return std::ranges::count(scene_generators(), name, &SceneEntry::name) > 0;
}

/// A spec of the scene, with the block's number of frames if it says one.
SceneSpec moving(const BlockReader& block, SceneSpec spec, SceneFile file) {
    file.n = spec.n;
    file.seed = spec.seed;
    const auto frames = block.integer("frames", 1, 100'000'000);
    if (frames && *frames != file.frames) {
        file.frames = *frames;
        file.name += fmt::format("_frames{}", file.frames);
    }
    spec.moving = std::make_shared<const SceneFile>(std::move(file));
    return spec;
}

/// The files of the user's that hold boxes frame by frame.
std::vector<SceneSpec> recordings(const BlockReader& block) {
    for (const char* key : {"n", "effects", "overlaps"})
        if (block.has(key))
            block.fail(fmt::format("{} is not for the scene \"{}\", which is read from a file", key,
                                   motion_scene),
                       key);
    std::vector<SceneSpec> all;
    for (const OwnScene& own : block.inputs().own) {
        if (own.generator != motion_scene)
            continue;
        SceneFile file;
        file.name = fmt::format("{}_{}", motion_scene, own.file.stem().string());
        file.title = fmt::format("motion {}, {{n}} bodies", own.file.stem().string());
        file.source = own.file.filename().string();
        file.recording = std::make_shared<const Recording>(read_recording(own.file));
        file.frames = file.recording->size() - 1;
        if (const auto frames = block.integer("frames", 1, 100'000'000);
            frames && *frames > file.frames)
            block.fail(
                fmt::format("{} has {} frames after its first", own.file.string(), file.frames),
                "frames");
        SceneSpec spec;
        spec.seed = block.inputs().seed;
        spec.generator = motion_scene;
        spec.file = own.file;
        spec.n = own.items;
        all.push_back(moving(block, spec, std::move(file)));
    }
    return all;
}

} // namespace

std::vector<SceneSpec> moving_scenes(const BlockReader& block) {
    const std::vector<std::string> names = block.moving_scenes();
    if (std::ranges::find(names, motion_scene) != names.end()) {
        if (names.size() > 1)
            block.fail(
                fmt::format("the scene \"{}\" needs a [[cells]] block of its own", motion_scene));
        return recordings(block);
    }
    const std::vector<std::vector<EffectChoice>> laid = block.effects();
    const std::vector<std::size_t> sizes = block.sizes({});
    const std::vector<double> overlaps = block.numbers("overlaps", 0, 1e6, {SceneSpec{}.overlaps});

    std::vector<SceneSpec> all;
    for (const std::string& name : names) {
        SceneSpec spec;
        spec.seed = block.inputs().seed;
        spec.generator = name;
        if (is_generator(name)) {
            if (laid.empty())
                block.fail(fmt::format("{} stands still: it needs effects, such as effects = "
                                       "\"drift\" (`boxwood list effects`), or name a moving scene",
                                       name));
            for (const std::size_t n : sizes.empty() ? std::vector{SceneSpec{}.n} : sizes)
                for (const double mean : overlaps)
                    for (const std::vector<EffectChoice>& effects : laid) {
                        spec.n = n;
                        spec.overlaps = mean;
                        all.push_back(moving(block, spec, effect_scene(spec, effects)));
                    }
            continue;
        }
        for (const char* key : {"effects", "overlaps"})
            if (block.has(key))
                block.fail(
                    fmt::format("{} is for generators; the moving scene {} has its own", key, name),
                    key);
        const SceneFile file = load_scene(name);
        spec.file = name.ends_with(".toml") ? name : "";
        for (const std::size_t n : sizes.empty() ? std::vector{file.n} : sizes) {
            spec.n = n;
            all.push_back(moving(block, spec, file));
        }
    }
    return all;
}

} // namespace boxwood::bench
