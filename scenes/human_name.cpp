#include "scenes/human_name.h"

#include "scenes/registry.h"
#include "scenes/robots/robot_scene.h"

#include <fmt/format.h>

#include <string_view>

namespace boxwood {
namespace {

/// 100000 as "100,000".
std::string grouped(std::size_t n) {
    std::string digits = std::to_string(n);
    for (std::size_t at = digits.size(); at > 3;) {
        at -= 3;
        digits.insert(at, 1, ',');
    }
    return digits;
}

std::string spaced(std::string_view name) {
    std::string text(name);
    for (char& c : text)
        if (c == '_')
            c = ' ';
    return text;
}

std::string counted(std::size_t n, std::string_view one, std::string_view more) {
    return fmt::format("{} {}", grouped(n), n == 1 ? one : more);
}

void replace(std::string& text, std::string_view what, const std::string& by) {
    if (const std::size_t at = text.find(what); at != std::string::npos)
        text.replace(at, what.size(), by);
}

std::string k_text(const HardCaseFamily& family, int k) {
    return family.k_words ? family.k_words(k) : fmt::format("k = {}", k);
}

std::string family_name(const HardCaseFamily& family, const SceneSpec& spec) {
    std::string text = spaced(family.name);
    if (family.reads_file)
        text += " of " + spec.file.string();
    text += ", " + counted(spec.n, "case", "cases");
    if (!family.k_meaning.empty())
        text += ", " + k_text(family, spec.k.value_or(family.k_default));
    if (spec.scale != 0)
        text += fmt::format(", scaled by 2^{}", spec.scale);
    return text;
}

std::string moving_name(const SceneFile& file, std::size_t n) {
    if (file.title.empty())
        return fmt::format("{}, {}", spaced(file.name), counted(n, "body", "bodies"));
    std::string text = file.title;
    replace(text, "{n}", grouped(n));
    return text;
}

} // namespace

std::string effect_title(const EffectChoice& effect) {
    std::string text = spaced(effect.name);
    if (effect.share != 1)
        text = fmt::format("{:.6g} % {}", 100 * effect.share, text);
    std::string settings;
    for (const auto& [name, value] : effect.settings)
        settings +=
            fmt::format("{}{} {}", settings.empty() ? "" : ", ", spaced(name), to_text(value));
    return settings.empty() ? text : fmt::format("{} ({})", text, settings);
}

std::string generator_title(const SceneSpec& spec, const SceneEntry& entry) {
    std::string text(entry.human_name);
    replace(text, "{file}", spec.file.stem().string());
    if (entry.uses_overlaps)
        text +=
            fmt::format(", {} {} each", spec.overlaps, spec.overlaps == 1 ? "overlap" : "overlaps");
    return text;
}

std::string human_name(const SceneSpec& spec) {
    if (spec.moving)
        return moving_name(*spec.moving, spec.n);
    if (const HardCaseFamily* family = find_hard_case_family(spec.generator))
        return family_name(*family, spec);
    if (spec.generator == robot_scene)
        return fmt::format("robot {}, {} {}", spec.file.stem().string(),
                           counted(spec.n_poses, "state", "states"),
                           spec.poses.empty() ? "at random" : "along a way");
    std::string text = generator_title(spec, scene_generator(spec.generator));
    replace(text, "{n}", grouped(spec.n));
    if (!spec.rays.empty())
        text += spec.rays_file.empty() ? fmt::format(", {} rays", spaced(spec.rays))
                                       : fmt::format(", rays {}", spec.rays_file.stem().string());
    if (spec.n_points != 0 && spec.regions.empty())
        text += ", " + counted(spec.n_points, "point", "points");
    if (spec.n_points != 0 && !spec.regions.empty())
        text += fmt::format(", {} regions, {}", grouped(spec.n_points), spaced(spec.regions));
    if (!spec.poses.empty())
        text += fmt::format(", {} of a copy, {}", counted(spec.n_poses, "pose", "poses"),
                            spaced(spec.poses));
    if (!spec.motion.empty())
        text += fmt::format(", {} motion", spaced(spec.motion));
    if (spec.k && spec.n_points != 0)
        text += fmt::format(", {} nearest each", *spec.k);
    return text;
}

} // namespace boxwood
