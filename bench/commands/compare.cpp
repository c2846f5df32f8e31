#include "bench/commands/compare.h"

#include "bench/analysis/wording.h"
#include "bench/commands/command.h"
#include "bench/io/json.h"
#include "bench/io/pattern.h"
#include "bench/io/read_results.h"
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

std::string said_of(const FileRow& row) {
    return row.is_newly_wrong ? "newly wrong" : row.comparison.words;
}

/// "REGRESSION: 2 of 120 timings are slower by more than 5 %", with the exit code it stands for.
std::string verdict_line(const FileComparison& comparison, const FileOptions& options) {
    std::map<Gate, std::size_t> count;
    std::size_t newly_wrong = 0;
    for (const FileRow& row : comparison.rows) {
        ++count[row.gate];
        newly_wrong += row.is_newly_wrong;
    }
    const std::string limit = fmt::format("{:g} %", 100 * options.fail_if.value_or(options.delta));
    const std::size_t n = comparison.rows.size(),
                      lost = comparison.only_base.size() + comparison.other_content.size();
    switch (comparison.gate) {
    case Gate::passes:
        return fmt::format("FINE: none of {} timings is slower by more than {}\n", n, limit);
    case Gate::fails: {
        std::string text = "REGRESSION:";
        if (const std::size_t slower = count[Gate::fails] - newly_wrong; slower > 0)
            text += fmt::format(" {} of {} timings slower{}{}", slower, n,
                                options.fail_if ? " by more than " + limit : "",
                                newly_wrong > 0 ? "," : "");
        if (newly_wrong > 0)
            text += fmt::format(" {} of {} answers newly wrong", newly_wrong, n);
        return text + "\n";
    }
    case Gate::open:
        break;
    }
    std::string text = "CAN'T TELL:";
    if (count[Gate::open] > 0)
        text += fmt::format(" {} of {} timings may be slower by more than {}{}", count[Gate::open],
                            n, limit, lost > 0 ? "," : "");
    if (lost > 0)
        text += fmt::format(" {} cells of the base cannot be compared", lost);
    return text + "\n";
}

std::string_view gate_word(Gate gate) {
    return gate == Gate::passes ? "passes" : gate == Gate::fails ? "fails" : "open";
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

int exit_code_of(Gate gate) {
    return gate == Gate::passes  ? exit_success
           : gate == Gate::fails ? exit_failed
                                 : exit_cannot_tell;
}

std::string comparison_text(const Results& base, const Results& head,
                            const FileComparison& comparison, const FileOptions& options,
                            bool markdown) {
    TextTable table({"cell", "phase", ">rounds", ">base", ">head", ">head/base", ">interval",
                     ">at most", "head is", "gate"});
    bool is_short = false;
    for (const FileRow& file_row : comparison.rows) {
        const Comparison& row = file_row.comparison;
        is_short = is_short || row.reason == Reason::too_few_rounds;
        table.add({file_row.name, std::string(to_string(row.phase)), std::to_string(row.n_pairs),
                   time_text(file_row.base_ns), time_text(file_row.head_ns), ratio_text(row.ratio),
                   fmt::format("{} to {}", ratio_text(row.ci_lo), ratio_text(row.ci_hi)),
                   ratio_text(file_row.max_ratio), said_of(file_row),
                   std::string(gate_word(file_row.gate))});
    }

    std::string text = verdict_line(comparison, options);
    text += fmt::format("base: {}\nhead: {}\n\n", commit_of(base), commit_of(head));
    text += markdown ? table.markdown() : table.text();
    text +=
        "\n\"interval\" decided \"head is\" (all rows corrected together); the gate passes a row "
        "whose \"at most\" (95 %\nof this row alone) is within the limit, and fails one that is "
        "slower with its interval above the limit\n";
    if (comparison.floor)
        text += fmt::format("A/A noise floor +-{:.1f} %: no difference below it is claimed\n",
                            100 * *comparison.floor);
    if (!comparison.is_same_machine)
        text += "The two files are of different machine states (another machine, build or "
                "commit): rounds are paired in order of time.\n";
    const std::size_t needed = rounds_needed(comparison.family_size);
    if (is_short || (comparison.gate == Gate::open && needed > min_pairs_verdict))
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
            "\"newly_wrong\": {}, \"max_ratio\": {}, \"gate\": \"{}\"}}",
            rows.empty() ? "" : ",", json_string(row.name), to_string(c.phase), c.n_pairs,
            json_number(c.ratio), json_number(c.ci_lo), json_number(c.ci_hi), json_number(c.p_adj),
            to_string(c.verdict), to_string(c.reason), row.is_newly_wrong,
            json_number(row.max_ratio), gate_word(row.gate));
    }
    return fmt::format("{{\"gate\": \"{}\", \"floor\": {}, \"same_machine\": {}, \"only_base\": "
                       "{}, \"only_head\": {}, "
                       "\"other_content\": {}, \"rows\": [{}]}}\n",
                       gate_word(comparison.gate), json_number(comparison.floor.value_or(unknown)),
                       comparison.is_same_machine, list_of(comparison.only_base),
                       list_of(comparison.only_head), list_of(comparison.other_content), rows);
}

void add_compare(CLI::App& app, int& exit_code) {
    struct Options {
        std::string base, head, fail_if, delta = "5%", only;
        bool all = false, markdown = false, json = false;
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
    compare->add_option("--only", options->only, "cells whose name has a match of this regex");
    compare->add_flag("--all", options->all, "peers too: where they changed, the machine did");
    CLI::Option* markdown =
        compare->add_flag("--markdown", options->markdown, "the table in Markdown");
    compare->add_flag("--json", options->json, "all of it as JSON")->excludes(markdown);
    compare->footer(
        "Example: boxwood compare base.h5 head.h5 --fail-if \"slower>5%\"\n"
        "Exit codes: 0 fine, 1 a regression, 2 bad input, 3 can't tell (too few or too noisy "
        "rounds, or cells of the base are gone).");
    compare->callback([options, &exit_code] {
        FileOptions chosen;
        chosen.delta = percent_of(options->delta);
        chosen.with_peers = options->all;
        if (!options->fail_if.empty())
            chosen.fail_if = fail_threshold(options->fail_if);
        if (!options->only.empty())
            chosen.wanted = [only = Pattern(options->only)](const std::string& name) {
                return only.is_in(name);
            };
        const Results base = read_results(options->base), head = read_results(options->head);
        const FileComparison comparison = compare_files(base, head, chosen);
        if (comparison.rows.empty() && comparison.other_content.empty())
            throw BadInput(fmt::format("compare: '{}' and '{}' have no timed cell {}in common{}",
                                       options->base, options->head, options->all ? "" : "of ours ",
                                       options->only.empty() ? "" : " that --only leaves"));
        std::cout << (options->json
                          ? comparison_json(comparison)
                          : comparison_text(base, head, comparison, chosen, options->markdown));
        exit_code = exit_code_of(comparison.gate);
    });
}

} // namespace boxwood::bench
