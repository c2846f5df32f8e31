#include "bench/analysis/wording.h"

#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace boxwood::bench {

using results::Comparison;
using results::Verdict;

std::string task_words(const std::string& task) {
    static const std::map<std::string, std::string> words{
        {"pairs", "overlapping pairs"},    {"tree_pairs", "pairs of two sets"},
        {"rays_closest", "nearest hit"},   {"rays_any", "any hit"},
        {"rays_all", "all hits"},          {"triangle_pairs", "touching triangles"},
        {"moving_pairs", "moving boxes"},  {"tree", "tree build"},
        {"points", "boxes at a point"},    {"regions", "boxes in a region"},
        {"nearest", "nearest boxes"},      {"closest_points", "nearest surface point"},
        {"scene_queries", "a whole scene"}};
    const auto found = words.find(task);
    return found == words.end() ? task : found->second;
}

std::string spaced(std::string name) {
    std::ranges::replace(name, '_', ' ');
    return name;
}

std::string count_words(std::uint64_t n) {
    return n >= 1'000'000 && n % 100'000 == 0 ? fmt::format("{:g}M", static_cast<double>(n) / 1e6)
           : n >= 1000 && n % 100 == 0        ? fmt::format("{:g}k", static_cast<double>(n) / 1e3)
                                              : std::to_string(n);
}

std::string library_words(const std::string& library) {
    static const std::map<std::string, std::string> words{
        {"fcl", "FCL"}, {"cgal", "CGAL"}, {"embree", "Embree"}, {"bullet", "Bullet"}};
    const auto found = words.find(library);
    return found == words.end() ? spaced(library) : found->second;
}

std::string class_words(const std::string& name) {
    const std::string tight = "watertight ";
    if (name.starts_with(tight))
        return "watertight " + class_words(name.substr(tight.size()));
    return name == "single rays"                   ? "one by one"
           : name == "batches against single rays" ? "batches"
                                                   : name;
}

Outcome outcome_of(const Comparison& row) {
    switch (row.verdict) {
    case Verdict::slower:
        return Outcome::loses;
    case Verdict::same:
        return Outcome::even;
    case Verdict::faster:
        return Outcome::wins;
    default:
        return Outcome::open;
    }
}

std::string short_ratio(double ratio) {
    return fmt::format("{:.{}f}", ratio, ratio >= 100 ? 0 : ratio >= 10 ? 1 : 2);
}

std::string outcome_text(const Comparison& row, const std::string& rival) {
    const std::string ratio = short_ratio(1 / row.ratio) + "x";
    const auto said = [&](std::string_view start, std::string_view link) {
        return rival.empty() ? std::string(start) : fmt::format("{} {}{}", start, link, rival);
    };
    switch (outcome_of(row)) {
    case Outcome::loses:
        return said("LOSES " + ratio, "to ");
    case Outcome::wins:
        return said("wins " + ratio, "over ");
    case Outcome::even:
        return said("even", "with ");
    case Outcome::open:
        break;
    }
    return "unsure, " + said(ratio, "");
}

std::string reason_text(results::Reason reason) {
    switch (reason) {
    case results::Reason::too_few_rounds:
        return "too few rounds";
    case results::Reason::below_the_floor:
        return "below the noise";
    case results::Reason::crosses_1:
        return "may be equal";
    case results::Reason::unchecked:
        return "unchecked";
    case results::Reason::none:
        break;
    }
    return "";
}

std::string certainty_text(const Comparison& row) {
    if (row.verdict == Verdict::cannot_tell && row.reason != results::Reason::crosses_1)
        return reason_text(row.reason);
    if (std::isnan(row.ci_lo))
        return "";
    return fmt::format("{}-{}", short_ratio(1 / row.ci_hi), short_ratio(1 / row.ci_lo));
}

std::string verdict_text(const Comparison& row) {
    if (row.verdict == Verdict::cannot_tell)
        return fmt::format("can't tell ({})", reason_text(row.reason));
    return row.verdict == Verdict::wrong ? "not ranked: a wrong answer"
                                         : std::string(to_string(row.verdict));
}

std::string interval_text(double ratio, double lo, double hi) {
    if (std::isnan(lo) || std::isnan(hi))
        return ratio_text(ratio);
    return fmt::format("{} [{}, {}]", ratio_text(ratio), ratio_text(lo), ratio_text(hi));
}

} // namespace boxwood::bench
