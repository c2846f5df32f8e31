#include "bench/plan/families.h"

#include "bench/truth/judging/judge.h"

#include <algorithm>
#include <array>
#include <map>

namespace boxwood::bench {
namespace {

constexpr std::array panels{Panel::generic, Panel::touching, Panel::degenerate};

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

std::vector<std::string_view> family_words() {
    std::vector<std::string_view> words{"all"};
    for (const Panel panel : panels)
        words.push_back(to_string(panel));
    for (const HardCaseFamily& family : hard_case_families())
        words.push_back(family.name);
    return words;
}

bool is_group(std::string_view word) {
    return word == "all" || std::ranges::find(panels, word, [](Panel panel) {
                                return to_string(panel);
                            }) != panels.end();
}

std::vector<const HardCaseFamily*> families_of(std::string_view word, Ask ask) {
    std::vector<const HardCaseFamily*> all;
    for (const HardCaseFamily& family : hard_case_families())
        if ((word == "all" || word == to_string(family.panel) || word == family.name) &&
            fits(sample_of(family), ask))
            all.push_back(&family);
    return all;
}

} // namespace boxwood::bench
