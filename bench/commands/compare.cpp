#include "bench/commands/compare.h"

#include "bench/analysis/wording.h"
#include "bench/commands/command.h"
#include "bench/io/json.h"
#include "bench/io/text_table.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <string_view>

namespace boxwood::bench {
namespace {

using results::Comparison;
using results::Reason;
using results::Results;
using results::Verdict;

/// Whether a slowdown by more than `limit` is not excluded. (Identical data need no interval.)
bool may_be_slower(const FileRow& row, double limit) {
    const Verdict verdict = row.comparison.verdict;
    if (verdict == Verdict::wrong || (verdict == Verdict::same && std::isnan(row.hi_95)))
        return false;
    return std::isnan(row.hi_95) || row.hi_95 > 1 + limit;
}

std::string said_of(const FileRow& row) {
    return row.is_newly_wrong ? "newly wrong"
           : row.comparison.verdict == Verdict::cannot_tell
               ? "can't tell"
               : std::string(to_string(row.comparison.verdict));
}

std::string commit_of(const Results& results) {
    std::string text;
    for (const auto& env : results.env)
        text +=
            fmt::format("{}{}{} on {}", text.empty() ? "" : ", ",
                        env.git_commit.empty() ? "?" : env.git_commit.substr(0, 12),
                        env.git_dirty ? " with changes" : "", env.host.empty() ? "?" : env.host);
    return text.empty() ? "no machine named" : text;
}

std::string names_text(std::string_view what, const std::vector<std::string>& names) {
    std::string text;
    if (!names.empty())
        text = fmt::format("\n{}:\n", what);
    for (const std::string& name : names)
        text += fmt::format("- {}\n", name);
    return text;
}

} // namespace

double percent_of(const std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
    if (error != std::errc() || !(unit == "%" || unit == " %") || !(value >= 0 && value <= 1000))
        throw BadInput(fmt::format("compare: '{}' is not a percentage such as 5%", text));
    return value / 100;
}

double fail_threshold(const std::string& condition) {
    constexpr std::string_view start = "slower>";
    std::string packed;
    for (const char c : condition)
        if (c != ' ')
            packed += c;
    if (!packed.starts_with(start))
        throw BadInput(fmt::format("compare: --fail-if takes \"slower>5%\" or another percentage, "
                                   "not '{}'",
                                   condition));
    return percent_of(packed.substr(start.size()));
}

int exit_code_of(const FileComparison& comparison, double delta, std::optional<double> fail_if) {
    bool is_open = !comparison.only_base.empty() || !comparison.other_content.empty();
    for (const FileRow& row : comparison.rows) {
        if (row.is_newly_wrong || (row.comparison.verdict == Verdict::slower &&
                                   row.comparison.ratio > 1 + fail_if.value_or(0)))
            return exit_failed;
        is_open = is_open || may_be_slower(row, fail_if.value_or(delta));
    }
    return is_open ? exit_cannot_tell : exit_success;
}

std::string comparison_text(const Results& base, const Results& head,
                            const FileComparison& comparison, bool markdown) {
    const MedianIndex base_ns(base), head_ns(head);
    TextTable table(
        {"cell", "phase", ">rounds", ">base", ">head", ">head/base", ">interval", ">p", "head is"});
    std::map<std::string, std::size_t> count;
    bool is_short = false;
    for (const FileRow& file_row : comparison.rows) {
        const Comparison& row = file_row.comparison;
        const std::string said = said_of(file_row);
        ++count[said];
        is_short = is_short || row.reason == Reason::too_few_rounds;
        table.add({file_row.name, std::string(to_string(row.phase)), std::to_string(row.n_pairs),
                   time_text(base_ns.ns(row.cell_a, row.phase)),
                   time_text(head_ns.ns(row.cell_b, row.phase)), ratio_text(row.ratio),
                   fmt::format("{} to {}", ratio_text(row.ci_lo), ratio_text(row.ci_hi)),
                   std::isnan(row.p_adj) ? "-" : fmt::format("{:.2g}", row.p_adj),
                   row.verdict == Verdict::cannot_tell ? verdict_text(row) : said});
    }

    std::string text = fmt::format("base: {}\nhead: {}\n\n", commit_of(base), commit_of(head));
    text += markdown ? table.markdown() : table.text();
    std::string sum;
    for (const char* said : {"slower", "newly wrong", "faster", "same", "can't tell", "wrong"})
        if (count[said] > 0)
            sum += fmt::format("{}{} {}", sum.empty() ? "" : ", ", count[said], said);
    text += "\n" + sum + "\n";
    if (comparison.floor)
        text += fmt::format("A/A noise floor +-{:.1f} %: no difference below it is claimed\n",
                            100 * *comparison.floor);
    if (!comparison.is_same_machine)
        text += "The two files are of different machine states (another machine, build or "
                "commit): rounds are paired in order of time.\n";
    const std::size_t needed = rounds_needed(comparison.family_size);
    if (is_short || (count["can't tell"] > 0 && needed > min_pairs_verdict))
        text += fmt::format("More rounds are needed: a verdict on {} comparisons at once takes at "
                            "least {} rounds in both files.\n",
                            comparison.family_size, needed);
    text += names_text("Only in the base", comparison.only_base);
    text += names_text("Only in the head", comparison.only_head);
    text += names_text("Not compared, as their scenes differ", comparison.other_content);
    return text;
}

std::string comparison_json(const FileComparison& comparison) {
    const auto list_of = [](const std::vector<std::string>& names) {
        std::string text;
        for (const std::string& name : names)
            text += (text.empty() ? "" : ", ") + json_string(name);
        return "[" + text + "]";
    };
    std::string rows;
    for (const FileRow& row : comparison.rows) {
        const Comparison& c = row.comparison;
        rows += fmt::format(
            "{}\n  {{\"cell\": {}, \"phase\": \"{}\", \"n_pairs\": {}, \"ratio\": {}, \"ci_lo\": "
            "{}, "
            "\"ci_hi\": {}, \"p_adj\": {}, \"verdict\": \"{}\", \"reason\": \"{}\", "
            "\"newly_wrong\": {}}}",
            rows.empty() ? "" : ",", json_string(row.name), to_string(c.phase), c.n_pairs,
            json_number(c.ratio), json_number(c.ci_lo), json_number(c.ci_hi), json_number(c.p_adj),
            to_string(c.verdict), to_string(c.reason), row.is_newly_wrong);
    }
    return fmt::format(
        "{{\"floor\": {}, \"same_machine\": {}, \"only_base\": {}, \"only_head\": {}, "
        "\"other_content\": {}, \"rows\": [{}]}}\n",
        json_number(comparison.floor.value_or(unknown)), comparison.is_same_machine,
        list_of(comparison.only_base), list_of(comparison.only_head),
        list_of(comparison.other_content), rows);
}

void add_compare(CLI::App& app, int& exit_code) {
    struct Options {
        std::string base, head, fail_if, delta = "5%";
        bool markdown = false, json = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* compare = app.add_subcommand(
        "compare", "compare the cells of two result files by paired rounds, with intervals");
    compare->add_option("base", options->base, "the result file to compare with")->required();
    compare->add_option("head", options->head, "the result file that is judged")->required();
    compare->add_option("--fail-if", options->fail_if,
                        "what counts as a regression, such as \"slower>5%\"; any verdict "
                        "\"slower\" if not given");
    compare->add_option("--delta", options->delta, "\"same\" means within this")
        ->capture_default_str();
    CLI::Option* markdown =
        compare->add_flag("--markdown", options->markdown, "the table in Markdown");
    compare->add_flag("--json", options->json, "all of it as JSON")->excludes(markdown);
    compare->footer(
        "Example: boxwood compare base.h5 head.h5 --fail-if \"slower>5%\"\n"
        "Exit codes: 0 fine, 1 a regression, 2 bad input, 3 can't tell (too few or too noisy "
        "rounds, or cells of the base are gone).");
    compare->callback([options, &exit_code] {
        const double delta = percent_of(options->delta);
        std::optional<double> fail_if;
        if (!options->fail_if.empty())
            fail_if = fail_threshold(options->fail_if);
        const Results base = results::read(options->base), head = results::read(options->head);
        const FileComparison comparison = compare_files(base, head, delta);
        if (comparison.rows.empty() && comparison.other_content.empty())
            throw BadInput(fmt::format("compare: '{}' and '{}' have no timed cell in common",
                                       options->base, options->head));
        std::cout << (options->json ? comparison_json(comparison)
                                    : comparison_text(base, head, comparison, options->markdown));
        exit_code = exit_code_of(comparison, delta, fail_if);
    });
}

} // namespace boxwood::bench
