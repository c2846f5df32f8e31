#include "bench/analysis/wording.h"

#include "bench/io/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boxwood::bench {

using results::Comparison;
using results::Verdict;

std::string count_words(std::uint64_t n) {
    return n >= 1'000'000 && n % 100'000 == 0 ? fmt::format("{:g}M", static_cast<double>(n) / 1e6)
           : n >= 1000 && n % 100 == 0        ? fmt::format("{:g}k", static_cast<double>(n) / 1e3)
                                              : std::to_string(n);
}

std::string peer_text(const results::Variant& peer) {
    return peer.library_title + ": " + peer.name.substr(peer.name.find('.') + 1);
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

std::string outcome_text(const Comparison& row, const std::string& rival) {
    const std::string ratio = ratio_text(1 / row.ratio) + "x";
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
    case results::Reason::too_noisy:
        return "too noisy";
    case results::Reason::memory_layout:
        return "flips with the memory layout";
    case results::Reason::none:
        break;
    }
    return "";
}

std::string certainty_text(const Comparison& row, double lo, double hi, std::string_view of) {
    if (row.verdict == Verdict::cannot_tell && row.reason != results::Reason::crosses_1)
        return reason_text(row.reason);
    return std::isnan(lo) ? ""
                          : fmt::format("{} to {}{}{}", ratio_text(lo), ratio_text(hi),
                                        of.empty() ? "" : " ", of);
}

std::string verdict_text(const Comparison& row) {
    if (row.verdict == Verdict::cannot_tell)
        return fmt::format("can't tell ({})", reason_text(row.reason));
    return row.verdict == Verdict::wrong ? "not ranked: a wrong answer"
                                         : std::string(to_string(row.verdict));
}

std::string interval_text(double ratio, double lo, double hi) {
    if (std::isnan(ratio))
        return "-";
    const std::string text = ratio_text(ratio) + "x";
    return std::isnan(lo) || std::isnan(hi)
               ? text
               : fmt::format("{} ({} to {})", text, ratio_text(lo), ratio_text(hi));
}

} // namespace boxwood::bench
