#include "scenes/effects/effect_scene.h"

#include "scenes/atom.h"
#include "scenes/effects/effect.h"
#include "scenes/human_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace boxwood {
namespace {

std::string value_atom(const SettingValue& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value))
        return atom(static_cast<double>(*whole));
    if (const auto* number = std::get_if<double>(&value))
        return atom(*number);
    return atom(to_text(value));
}

} // namespace

SceneFile effect_scene(const SceneSpec& spec, std::span<const EffectChoice> effects) {
    SceneFile file;
    file.source = "Boxwood";
    file.licence = "Apache-2.0";
    file.name = scene_name(
        {.generator = spec.generator, .n = spec.n, .seed = spec.seed, .overlaps = spec.overlaps});
    const auto entry = std::ranges::find(scene_generators(), spec.generator, &SceneEntry::name);
    if (entry == scene_generators().end() || entry->has_mesh)
        throw std::invalid_argument(
            fmt::format("scene {} is one body of triangles; lay effects on a scene of boxes such "
                        "as uniform, or write a scene file",
                        spec.generator));
    for (const auto& [name, settings, share] : effects) {
        effect_of(name).make(settings); // throws for a bad name or setting
        file.name += '_' + name;
        for (const auto& [setting, value] : settings)
            file.name += '_' + setting + value_atom(value);
        if (share != 1)
            file.name += "_share" + atom(share);
    }
    file.title = generator_title(spec, *entry);
    for (const EffectChoice& effect : effects)
        file.title += ", " + effect_title(effect);
    file.summary = fmt::format("{} with effects", spec.generator);
    file.n = spec.n;
    file.seed = spec.seed;
    file.frames = default_frames;
    BodyGroup group;
    group.generator = spec.generator;
    group.overlaps = spec.overlaps;
    group.effects.assign(effects.begin(), effects.end());
    file.groups.push_back(std::move(group));
    return file;
}

} // namespace boxwood
