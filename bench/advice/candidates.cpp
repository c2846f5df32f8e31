#include "bench/advice/candidates.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace boxwood::bench {
namespace {

bool is_bettered(const Way& way, const std::vector<Way>& ways) {
    return std::ranges::any_of(ways, [&](const Way& other) {
        const bool is_like = other.layout == way.layout || other.builder == way.builder;
        return is_like && other.build_ns < .9 * way.build_ns && other.query_ns < .95 * way.query_ns;
    });
}

/// The names of the ways that are meant and may be best, each once.
std::vector<std::string> kept(const Advice& first, std::string Way::*name,
                              const std::function<bool(const Way&)>& is_meant) {
    std::vector<std::string> names;
    for (double queries = 1; queries < 1e12; queries *= 2) {
        const auto total = [&](const Way& way) { return total_ns(first, way, queries); };
        double min_ns = std::numeric_limits<double>::infinity(), least_ns = min_ns;
        for (const Way& way : first.ways) {
            least_ns = std::min(least_ns, total(way));
            if (is_meant(way))
                min_ns = std::min(min_ns, total(way));
        }
        if (2 * least_ns < min_ns)
            continue; // for so many queries others are far ahead of all of these
        for (const Way& way : first.ways)
            if (is_meant(way) && total(way) <= 1.2 * min_ns && !is_bettered(way, first.ways) &&
                std::ranges::find(names, way.*name) == names.end())
                names.push_back(way.*name);
    }
    return names;
}

} // namespace

Candidates candidates_of(const Advice& first, std::string_view layout, std::string_view builder) {
    return {kept(first, &Way::builder, [&](const Way& way) { return way.layout == layout; }),
            kept(first, &Way::layout, [&](const Way& way) { return way.builder == builder; })};
}

} // namespace boxwood::bench
