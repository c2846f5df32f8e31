#include "scenes/hard_cases/hard_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

// To add a family: its file, which defines `HardCaseFamily NAME_family()`, and its word here.
#define BOXWOOD_FAMILIES(X)

namespace boxwood {

#define BOXWOOD_DECLARE(word) HardCaseFamily word##_family();
BOXWOOD_FAMILIES(BOXWOOD_DECLARE)
#undef BOXWOOD_DECLARE

std::string_view to_string(Panel panel) {
    return panel == Panel::generic    ? "generic"
           : panel == Panel::touching ? "touching"
                                      : "degenerate";
}

std::span<const HardCaseFamily> hard_case_families() {
#define BOXWOOD_ROW(word) word##_family(),
    static const std::vector<HardCaseFamily> families{BOXWOOD_FAMILIES(BOXWOOD_ROW)};
#undef BOXWOOD_ROW
    return families;
}

const HardCaseFamily* find_hard_case_family(std::string_view name) {
    const auto found = std::ranges::find(hard_case_families(), name, &HardCaseFamily::name);
    return found == hard_case_families().end() ? nullptr : &*found;
}

Cases make_cases(const HardCaseFamily& family, const HardCaseSpec& spec) {
    const int k = spec.k.value_or(family.k_default);
    if (k < family.k_least || k > family.k_most)
        throw std::invalid_argument(fmt::format("family {}: k = {} is not within {} .. {}",
                                                family.name, k, family.k_least, family.k_most));
    if (spec.scale < family.scale_least || spec.scale > family.scale_most)
        throw std::invalid_argument(fmt::format("family {}: scale = {} is not within {} .. {}",
                                                family.name, spec.scale, family.scale_least,
                                                family.scale_most));
    HardCaseSpec full = spec;
    full.k = k;
    return family.generate(full);
}

} // namespace boxwood
