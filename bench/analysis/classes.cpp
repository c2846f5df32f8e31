#include "bench/analysis/classes.h"

#include <algorithm>
#include <map>

namespace boxwood::bench {
namespace {

constexpr char separator = ',';

bool says_any(const std::string& name, std::initializer_list<const char*> parts) {
    return std::ranges::any_of(
        parts, [&](const char* part) { return name.find(part) != std::string::npos; });
}

} // namespace

std::vector<std::string> classes_of(const results::Cell& cell, const results::Variant& variant) {
    if (!cell.task.starts_with("rays_"))
        return {""};
    const std::string single = "single rays", batches = "batches against single rays",
                      packets = "packets";
    std::vector<std::string> classes;
    const auto add_watertight = [&] {
        for (const std::string& name : std::vector(classes))
            classes.push_back("watertight " + name);
    };
    if (variant.is_peer) {
        if (says_any(variant.name, {"sect8", "sect16", "occluded8", "occluded16"}))
            classes = {packets};
        else
            classes = {single, batches};
        if (says_any(variant.name, {".robust"})) {
            const std::size_t loose = classes.size();
            add_watertight();
            classes.erase(classes.begin(), classes.begin() + static_cast<std::ptrdiff_t>(loose));
        }
        return classes;
    }
    if (variant.traversal == "single_rays")
        classes = {single};
    else if (variant.traversal == "sorted_rays")
        classes = {packets};
    else
        classes = {packets, batches};
    if (variant.kernel == "watertight")
        add_watertight();
    return classes;
}

void set_classes(results::Results& results) {
    std::map<std::uint32_t, const results::Variant*> variants;
    for (const results::Variant& variant : results.variants)
        variants[variant.variant_id] = &variant;
    for (results::Cell& cell : results.cells) {
        cell.classes.clear();
        const auto variant = variants.find(cell.variant_id);
        if (variant == variants.end())
            continue;
        for (const std::string& name : classes_of(cell, *variant->second))
            cell.classes += (cell.classes.empty() ? "" : std::string(1, separator)) + name;
    }
}

std::vector<std::string> split_classes(const std::string& classes) {
    std::vector<std::string> names;
    for (std::size_t start = 0; start <= classes.size();) {
        const std::size_t end = std::min(classes.find(separator, start), classes.size());
        names.push_back(classes.substr(start, end - start));
        start = end + 1;
    }
    return names;
}

} // namespace boxwood::bench
