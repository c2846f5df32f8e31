#include "bench/commands/compare_counts.h"

#include "bench/io/json.h"
#include "bench/io/text_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace boxwood::bench {
namespace {

std::string_view word_of(CountRow::Change change) {
    return change == CountRow::Change::more    ? "more"
           : change == CountRow::Change::fewer ? "fewer"
                                               : "same";
}

/// "+1.25 %".
std::string difference_text(const CountRow& row) {
    return std::isnan(row.ratio()) ? "-" : fmt::format("{:+.2f} %", 100 * (row.ratio() - 1));
}

/// "; worst +1.25 %: rays_closest/..., instructions_query".
std::string worst_text(const CountComparison& comparison) {
    const auto worst = std::ranges::max_element(comparison.rows, {}, [](const CountRow& row) {
        return row.is_expected || std::isnan(row.ratio()) ? 0 : row.ratio();
    });
    if (worst == comparison.rows.end() || worst->base == worst->head)
        return "\n";
    return fmt::format("; worst {}: {}, {}\n", difference_text(*worst), worst->cell,
                       worst->counter);
}

/// "REGRESSION: 2 of 800 counts are more", with the exit code it stands for.
std::string counts_verdict(const CountComparison& comparison, const CountOptions& options) {
    const std::string by =
        fmt::format(" (of instructions and bytes by more than {:g} %)", 100 * options.more);
    if (comparison.gate == Gate::passes)
        return fmt::format("FINE: none of {} counts is more{}", comparison.rows.size(), by) +
               worst_text(comparison);
    std::vector<std::string> parts;
    const auto with = [&](Gate gate) {
        return std::ranges::count(comparison.rows, gate, &CountRow::gate);
    };
    if (comparison.gate == Gate::fails) {
        if (const auto n = with(Gate::fails); n > 0)
            parts.push_back(fmt::format("{} of {} counts more{}", n, comparison.rows.size(), by));
        if (const std::size_t n = comparison.newly_wrong.size(); n > 0)
            parts.push_back(
                fmt::format("the answers of {} cell{} newly wrong", n, n > 1 ? "s" : ""));
        return fmt::format("REGRESSION: {}{}", fmt::join(parts, ", "), worst_text(comparison));
    }
    if (!comparison.is_sealed)
        parts.emplace_back(no_evidence);
    if (comparison.has_instructions && with(Gate::open) > 0)
        parts.push_back(fmt::format("instructions were counted by {} and by {}, which give other "
                                    "numbers for the same code",
                                    comparison.base_by, comparison.head_by));
    if (!comparison.lost.empty())
        parts.push_back(fmt::format("{} of the base's cells, counters or answers have no "
                                    "counterpart",
                                    comparison.lost.size()));
    if (!comparison.has_instructions)
        parts.push_back("no instructions were counted in the base: boxwood sweep --count does");
    if (comparison.rows.empty())
        parts.push_back("no counter of ours is in both files");
    return fmt::format("CAN'T TELL: {}\n", fmt::join(parts, ", "));
}

} // namespace

std::string counts_text(const results::Results& base, const results::Results& head,
                        const CountComparison& comparison, const CountOptions& options,
                        const FileView& view) {
    std::string text =
        counts_verdict(comparison, options) + file_text("base", base) + file_text("head", head);
    for (const std::string& cell : comparison.newly_wrong)
        text += fmt::format("newly wrong: {}\n", cell);
    for (const Lost& lost : comparison.lost)
        text += fmt::format("lost: {}: {} in the head\n", lost.cell, lost.why);
    TextTable table({"cell", "counter", ">base", ">head", ">difference", "head is", "gate"});
    for (const CountRow& row : comparison.rows)
        if (view.all || row.change != CountRow::Change::same)
            table.add(
                {row.cell, row.counter, std::to_string(row.base), std::to_string(row.head),
                 difference_text(row),
                 fmt::format("{}{}", word_of(row.change), row.is_expected ? ", as expected" : ""),
                 std::string(gate_word(row.gate))});
    if (!table.empty())
        text += "\n" + (view.markdown ? table.markdown() : table.text());
    if (!view.all)
        return text + "every row: --all\n";
    if (!comparison.only_head.empty())
        text += "\nonly in the head:\n";
    for (const std::string& name : comparison.only_head)
        text += fmt::format("- {}\n", name);
    return text;
}

std::string counts_json(const CountComparison& comparison) {
    std::vector<std::string> rows, lost;
    for (const CountRow& row : comparison.rows)
        rows.push_back(fmt::format(
            "\n  {{\"cell\": {}, \"counter\": {}, \"base\": {}, \"head\": {}, \"ratio\": {}, "
            "\"change\": \"{}\", \"expected\": {}, \"gate\": \"{}\"}}",
            json_string(row.cell), json_string(row.counter), row.base, row.head,
            json_number(row.ratio()), word_of(row.change), row.is_expected, gate_word(row.gate)));
    for (const Lost& what : comparison.lost)
        lost.push_back(fmt::format("{{\"cell\": {}, \"why\": {}}}", json_string(what.cell),
                                   json_string(what.why)));
    return fmt::format("{{\"gate\": \"{}\", \"base_by\": {}, \"head_by\": {}, \"newly_wrong\": "
                       "[{}], \"lost\": [{}], \"only_head\": [{}], \"rows\": [{}]}}\n",
                       gate_word(comparison.gate), json_string(comparison.base_by),
                       json_string(comparison.head_by),
                       fmt::join(json_strings(comparison.newly_wrong), ", "), fmt::join(lost, ", "),
                       fmt::join(json_strings(comparison.only_head), ", "), fmt::join(rows, ", "));
}

} // namespace boxwood::bench
