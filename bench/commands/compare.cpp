#include "bench/commands/compare.h"

#include "bench/commands/command.h"
#include "bench/io/text_table.h"

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
using results::Results;

/// Whether a slowdown by more than `limit` is not excluded. (Identical data need no interval.)
bool may_be_slower(const Comparison& row, double limit) {
    if (row.verdict == "wrong" || (row.verdict == "same" && std::isnan(row.ci_hi)))
        return false;
    return std::isnan(row.ci_hi) || row.ci_hi > 1 + limit;
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
        if (row.is_newly_wrong ||
            (row.comparison.verdict == "slower" && row.comparison.ratio > 1 + fail_if.value_or(0)))
            return exit_failed;
        is_open = is_open || may_be_slower(row.comparison, fail_if.value_or(delta));
    }
    return is_open ? exit_cannot_tell : exit_success;
}

std::string comparison_text(const Results& base, const Results& head,
                            const FileComparison& comparison, bool markdown) {
    std::map<std::pair<std::uint32_t, std::string>, double> base_ns, head_ns;
    for (const CellStats& stats : cell_stats(base))
        base_ns[{stats.cell_id, stats.phase}] = stats.median_ns;
    for (const CellStats& stats : cell_stats(head))
        head_ns[{stats.cell_id, stats.phase}] = stats.median_ns;
    const auto median = [](const auto& medians, std::uint32_t cell, const std::string& phase) {
        const auto found = medians.find({cell, phase});
        return time_text(found == medians.end() ? unknown : found->second);
    };

    TextTable table({"cell", "phase", ">rounds", ">base", ">head", ">head/base", ">95 % interval",
                     ">p", "head is"});
    std::map<std::string, std::size_t> count;
    bool is_short = false;
    for (const auto& [name, row, is_newly_wrong] : comparison.rows) {
        const std::string said = row.verdict == "cannot_tell" ? "can't tell"
                                 : is_newly_wrong             ? "newly wrong"
                                                              : row.verdict;
        ++count[said];
        is_short = is_short || (said == "can't tell" && row.n_pairs < least_pairs_verdict);
        table.add({name, row.phase, std::to_string(row.n_pairs),
                   median(base_ns, row.cell_a, row.phase), median(head_ns, row.cell_b, row.phase),
                   ratio_text(row.ratio),
                   fmt::format("{} to {}", ratio_text(row.ci_lo), ratio_text(row.ci_hi)),
                   std::isnan(row.p_adj) ? "-" : fmt::format("{:.2g}", row.p_adj), said});
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
    if (is_short || (count["can't tell"] > 0 && needed > least_pairs_verdict))
        text += fmt::format("More rounds are needed: a verdict on {} comparisons at once takes at "
                            "least {} rounds in both files.\n",
                            comparison.family_size, needed);
    text += names_text("Only in the base", comparison.only_base);
    text += names_text("Only in the head", comparison.only_head);
    text += names_text("Not compared, as their scenes differ", comparison.other_content);
    return text;
}

void add_compare(CLI::App& app, int& exit_code) {
    struct Options {
        std::string base, head, fail_if, delta = "5%";
        bool markdown = false;
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
    compare->add_flag("--markdown", options->markdown, "the table in Markdown");
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
        std::cout << comparison_text(base, head, comparison, options->markdown);
        exit_code = exit_code_of(comparison, delta, fail_if);
    });
}

} // namespace boxwood::bench
