#include "bench/plan/families.h"

#include "bench/plan/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace boxwood::bench {
namespace {

constexpr std::array panels{Panel::generic, Panel::touching, Panel::degenerate};

/// What the scene key of a sweep file may say: families, "all", and the panels.
std::vector<std::string_view> family_names() {
    std::vector<std::string_view> names{"all"};
    for (const Panel panel : panels)
        names.push_back(to_string(panel));
    for (const HardCaseFamily& family : hard_case_families())
        names.push_back(family.name);
    return names;
}

/// Whether a name stands for several families.
bool is_group(std::string_view name) {
    return name == "all" ||
           std::ranges::any_of(panels, [&](Panel panel) { return to_string(panel) == name; });
}

/// Refuses a name that stands for nothing here.
void require_cases(const BlockReader& block, std::string_view name, const Task& task) {
    if (is_group(name) && block.has("k"))
        block.fail(fmt::format("k means something else for each family: name the families instead "
                               "of \"{}\"",
                               name),
                   "k");
    if (!families_of(name, task).empty())
        return;
    block.fail(is_group(name) || !find_hard_case_family(name)->reads_file
                   ? fmt::format("\"{}\" has no cases for the task {}", name, task.name())
                   : fmt::format("the family \"{}\" reads files: only `boxwood check --ccd DIR` "
                                 "takes it",
                                 name),
               "scene");
}

} // namespace

const Cases& sample_of(const HardCaseFamily& family) {
    static const std::map<std::string_view, Cases> samples = [] {
        std::map<std::string_view, Cases> all;
        for (const HardCaseFamily& f : hard_case_families()) {
            HardCaseSpec spec;
            spec.n = 1;
            spec.scale = std::clamp(0, f.scale_min, f.scale_max);
            all.emplace(f.name, f.reads_file ? Cases() : make_cases(f, spec));
        }
        return all;
    }();
    return samples.at(family.name);
}

std::vector<const HardCaseFamily*> families_of(std::string_view name, const Task& task) {
    std::vector<const HardCaseFamily*> all;
    for (const HardCaseFamily& family : hard_case_families())
        if ((name == "all" || name == to_string(family.panel) || name == family.name) &&
            task.fits(sample_of(family)))
            all.push_back(&family);
    return all;
}

/// A group of families skips those that a scale is out of range for; a named family refuses it.
std::vector<SceneSpec> case_scenes(const BlockReader& block, const Task& task) {
    constexpr std::int64_t max_parameter = 100'000;
    const auto all_k = block.integers("k", -max_parameter, max_parameter);
    const auto scales = block.integers("scale", -max_parameter, max_parameter, {0});
    const std::vector<std::size_t> sizes = block.sizes({SceneSpec{}.n});
    std::vector<std::optional<int>> parameters;
    for (const std::int64_t k : all_k)
        parameters.emplace_back(static_cast<int>(k));
    if (parameters.empty())
        parameters.emplace_back();

    std::vector<SceneSpec> all;
    SceneSpec spec;
    spec.seed = block.inputs().seed;
    for (const std::string& name : block.names("scene", family_names())) {
        require_cases(block, name, task);
        for (const HardCaseFamily* family : families_of(name, task))
            for (const std::size_t n : sizes)
                for (const std::optional<int> k : parameters)
                    for (const std::int64_t scale : scales) {
                        if (is_group(name) &&
                            (scale < family->scale_min || scale > family->scale_max))
                            continue;
                        spec.generator = family->name;
                        spec.n = n;
                        spec.k = k;
                        spec.scale = static_cast<int>(scale);
                        all.push_back(spec);
                    }
    }
    return all;
}

} // namespace boxwood::bench
