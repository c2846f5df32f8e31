#include "bench/commands/compare.h"

#include "bench/analysis/wording.h"
#include "bench/commands/command.h"
#include "bench/commands/compare_counts.h"
#include "bench/io/json.h"
#include "bench/io/pattern.h"
#include "bench/io/read_results.h"
#include "bench/io/text_table.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>
#include <set>
#include <string_view>

namespace boxwood::bench {
namespace {

using results::Comparison;
using results::Reason;
using results::Results;

std::string said_of(const FileRow& row) {
    return row.is_newly_wrong ? "newly wrong" : row.comparison.words;
}

/// What the rows come to.
struct Counts {
    std::size_t timings = 0, slower = 0, open = 0;
    std::set<std::string> newly_wrong; ///< cells

    explicit Counts(const FileComparison& comparison) {
        for (const FileRow& row : comparison.rows)
            if (row.is_newly_wrong) {
                newly_wrong.insert(row.name);
            } else if (row.comparison.verdict != results::Verdict::wrong) {
                ++timings;
                slower += row.gate == Gate::fails;
                open += row.gate == Gate::open;
            }
    }
};

std::string comma_list(const std::vector<std::string>& parts) {
    return fmt::format("{}", fmt::join(parts, ", "));
}

/// "; together 1.002x (0.998 to 1.005), worst 1.31x: rays_closest/..., query".
std::string summary_text(const FileComparison& comparison) {
    std::string text;
    if (!std::isnan(comparison.together.ratio))
        text += "; together " + interval_text(comparison.together.ratio, comparison.together.ci_lo,
                                              comparison.together.ci_hi);
    const FileRow* worst = nullptr;
    for (const FileRow& row : comparison.rows)
        if (!std::isnan(row.comparison.ratio) &&
            (!worst || row.comparison.ratio > worst->comparison.ratio))
            worst = &row;
    if (worst)
        text += fmt::format(", worst {}x: {}, {}", ratio_text(worst->comparison.ratio), worst->name,
                            to_string(worst->comparison.phase));
    return text + "\n";
}

/// What to do about timings that are open.
std::string what_would_tell(const FileComparison& comparison, const FileOptions& options,
                            std::size_t open) {
    if (open == 0)
        return "";
    std::string text = "To tell: more rounds on a quiet machine; both programs in turns (sweep "
                       "--against); instructions instead of times (sweep --count)";
    if (const double floor = 100 * comparison.floor.value_or(0); floor > 100 * options.limit())
        text += fmt::format("; or --fail-if \"slower>{:.0f}%\", which these files may answer",
                            std::ceil(floor));
    return text + ".\n";
}

/// "REGRESSION: 2 of 120 timings are slower by more than 5 %", with the exit code it stands for.
std::string verdict_line(const FileComparison& comparison, const FileOptions& options) {
    const Counts counts(comparison);
    const std::string by = fmt::format(" by more than {:g} %", 100 * options.limit());
    if (comparison.gate == Gate::passes &&
        std::ranges::all_of(comparison.rows, &FileRow::is_same_samples))
        return fmt::format("SAME: both files hold the same samples of {} timings\n",
                           counts.timings);
    if (comparison.gate == Gate::passes)
        return fmt::format("FINE: none of {} timings is slower{}", counts.timings, by) +
               summary_text(comparison);
    std::vector<std::string> parts;
    if (comparison.gate == Gate::fails) {
        if (counts.slower > 0)
            parts.push_back(fmt::format("{} of {} timings slower{}", counts.slower, counts.timings,
                                        options.fail_if ? by : ""));
        if (const std::size_t n = counts.newly_wrong.size(); n > 0)
            parts.push_back(
                fmt::format("the answers of {} cell{} newly wrong", n, n > 1 ? "s" : ""));
        return "REGRESSION: " + comma_list(parts) + summary_text(comparison);
    }
    if (!comparison.is_sealed)
        parts.emplace_back(no_evidence);
    if (!comparison.is_same_cpu && !options.any_processor)
        parts.push_back("the processors differ, and so do times for that alone "
                        "(--any-processor compares all the same)");
    else if (comparison.peers_moved)
        parts.push_back(fmt::format("the machine changed and not our code alone, as the peers take "
                                    "{} of their time",
                                    ratio_text(comparison.peers_ratio)));
    else if (comparison.floor.value_or(0) > options.limit() && counts.open > 0)
        parts.push_back(fmt::format("the noise floor of {:.1f} % is above {:g} %, and so {} of {} "
                                    "timings are open",
                                    100 * *comparison.floor, 100 * options.limit(), counts.open,
                                    counts.timings));
    else if (counts.open > 0)
        parts.push_back(
            fmt::format("{} of {} timings may be slower{}", counts.open, counts.timings, by));
    if (!comparison.lost.empty())
        parts.push_back(fmt::format("{} of the base's timings or answers have no counterpart",
                                    comparison.lost.size()));
    if (counts.timings == 0)
        parts.push_back("no timing of ours with right answers is in both files");
    return "CAN'T TELL: " + comma_list(parts) + summary_text(comparison) +
           what_would_tell(comparison, options, counts.open);
}

/// What a reader has to know before the table.
std::string notes_text(const FileComparison& comparison) {
    std::string text;
    if (!std::isnan(comparison.peers_ratio))
        text += fmt::format("peers' timings: {}, the middle one takes {} of its time in the base\n",
                            comparison.peers.size(), ratio_text(comparison.peers_ratio));
    else
        text +=
            "no peer was timed in both files: a change of the machine cannot be told from one of "
            "ours\n";
    if (comparison.floor)
        text +=
            fmt::format("A/A noise floor up to +-{:.1f} %: no difference below that of its class "
                        "is claimed\n",
                        100 * *comparison.floor);
    if (!comparison.is_same_machine)
        text +=
            "two machine states (machine, build or commit): rounds are paired in order of time\n";
    const std::size_t needed = rounds_needed(comparison.max_family);
    if (std::ranges::any_of(comparison.rows, [&](const FileRow& row) {
            return row.gate == Gate::open && row.comparison.n_pairs > 0 &&
                   row.comparison.n_pairs < needed;
        }))
        text += fmt::format("more rounds are needed: for one verdict among {} comparisons of one "
                            "job it takes at least {} rounds in both files\n",
                            comparison.max_family, needed);
    return text;
}

std::string table_text(const std::vector<FileRow>& rows, const FileView& view) {
    TextTable table({"cell", "phase", ">rounds", ">base", ">head", ">head/base", ">interval",
                     ">at most", "head is", "gate"});
    for (const FileRow& file_row : rows) {
        const Comparison& row = file_row.comparison;
        const bool is_news = file_row.gate != Gate::passes ||
                             row.verdict == results::Verdict::faster ||
                             row.verdict == results::Verdict::slower;
        if (view.all || is_news)
            table.add({file_row.name, std::string(to_string(row.phase)),
                       std::to_string(row.n_pairs), time_text(file_row.base_ns),
                       time_text(file_row.head_ns), ratio_text(row.ratio),
                       fmt::format("{} to {}", ratio_text(row.ci_lo), ratio_text(row.ci_hi)),
                       ratio_text(file_row.max_ratio), said_of(file_row),
                       std::string(gate_word(file_row.gate))});
    }
    if (table.empty())
        return "";
    return "\n" + (view.markdown ? table.markdown() : table.text());
}

} // namespace

std::string_view gate_word(Gate gate) {
    return gate == Gate::passes ? "passes" : gate == Gate::fails ? "fails" : "open";
}

std::string file_text(std::string_view which, const Results& results) {
    std::string text;
    for (const auto& env : results.env)
        text += fmt::format(
            "{}{}{} on {}, {}", text.empty() ? "" : "; ", or_unknown(env.git_commit.substr(0, 12)),
            env.git_dirty ? " with changes" : "", or_unknown(env.host), or_unknown(env.cpu));
    return fmt::format("{}: {}{}\n", which, text.empty() ? "no machine named" : text,
                       results.is_sealed
                           ? ""
                           : "\n  THIS FILE WAS CHANGED after it was written: it need "
                             "not say what was measured");
}

double percent_of(const std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
    if (error != std::errc() || !(unit == "%" || unit == " %") || !(value >= 0 && value <= 1000))
        throw BadInput(fmt::format("compare: '{}' is not a percentage such as 5%", text));
    return value / 100;
}

double fail_threshold(const std::string& condition, std::string_view change) {
    const std::string start = fmt::format("{}>", change);
    std::string packed;
    for (const char c : condition)
        if (c != ' ')
            packed += c;
    if (!packed.starts_with(start))
        throw BadInput(fmt::format("compare: --fail-if takes \"{}5%\" or another percentage, not "
                                   "'{}'",
                                   start, condition));
    return percent_of(packed.substr(start.size()));
}

int exit_code_of(Gate gate) {
    return gate == Gate::passes  ? exit_success
           : gate == Gate::fails ? exit_failed
                                 : exit_cannot_tell;
}

std::string comparison_text(const Results& base, const Results& head,
                            const FileComparison& comparison, const FileOptions& options,
                            const FileView& view) {
    std::string text =
        verdict_line(comparison, options) + file_text("base", base) + file_text("head", head);
    if (!comparison.is_same_cpu && !options.any_processor && comparison.gate == Gate::open)
        return text;
    text += notes_text(comparison);
    for (const Lost& lost : comparison.lost)
        text += fmt::format("lost: {}: {} in the head\n", lost.cell, lost.why);
    const std::string table = table_text(comparison.rows, view);
    text += table;
    if (!table.empty())
        text += "\n\"interval\" decided \"head is\" (rows of one job corrected together); the gate "
                "passes a row whose \"at most\"\n(95 % of this row alone) is within the limit, and "
                "fails one that is slower with its interval above the limit\n";
    if (!view.all)
        return text + "every row, and the peers': --all\n";
    std::vector<FileRow> peers;
    for (const FileRow& row : comparison.peers)
        if (!options.wanted || options.wanted(row.name))
            peers.push_back(row);
    if (const std::string peers_table = table_text(peers, view); !peers_table.empty())
        text += "\npeers, which no gate looks at:\n" + peers_table;
    if (!comparison.only_head.empty())
        text += "\nonly in the head:\n";
    for (const std::string& name : comparison.only_head)
        text += fmt::format("- {}\n", name);
    return text;
}

std::string comparison_json(const Results& base, const Results& head,
                            const FileComparison& comparison) {
    const auto rows_json = [](const std::vector<FileRow>& file_rows) {
        std::vector<std::string> rows;
        for (const FileRow& row : file_rows) {
            const Comparison& c = row.comparison;
            rows.push_back(fmt::format(
                "\n  {{\"cell\": {}, \"phase\": \"{}\", \"n_pairs\": {}, \"ratio\": {}, \"ci_lo\": "
                "{}, \"ci_hi\": {}, \"p_adj\": {}, \"verdict\": \"{}\", \"reason\": \"{}\", "
                "\"newly_wrong\": {}, \"max_ratio\": {}, \"gate\": \"{}\"}}",
                json_string(row.name), to_string(c.phase), c.n_pairs, json_number(c.ratio),
                json_number(c.ci_lo), json_number(c.ci_hi), json_number(c.p_adj),
                to_string(c.verdict), to_string(c.reason), row.is_newly_wrong,
                json_number(row.max_ratio), gate_word(row.gate)));
        }
        return "[" + comma_list(rows) + "]";
    };
    std::vector<std::string> lost, only_head;
    for (const Lost& what : comparison.lost)
        lost.push_back(fmt::format("{{\"cell\": {}, \"why\": {}}}", json_string(what.cell),
                                   json_string(what.why)));
    for (const std::string& name : comparison.only_head)
        only_head.push_back(json_string(name));
    return fmt::format(
        "{{\"gate\": \"{}\", \"together\": {{\"ratio\": {}, \"ci_lo\": {}, \"ci_hi\": {}}}, "
        "\"sealed\": {{\"base\": {}, \"head\": {}}}, \"same_cpu\": {}, "
        "\"same_machine\": {}, \"peers_moved\": {}, \"peers_ratio\": {}, \"floor\": {}, \"lost\": "
        "[{}], \"only_head\": [{}], \"rows\": {}, \"peers\": {}}}\n",
        gate_word(comparison.gate), json_number(comparison.together.ratio),
        json_number(comparison.together.ci_lo), json_number(comparison.together.ci_hi),
        base.is_sealed, head.is_sealed, comparison.is_same_cpu, comparison.is_same_machine,
        comparison.peers_moved, json_number(comparison.peers_ratio),
        json_number(comparison.floor.value_or(unknown)), comma_list(lost), comma_list(only_head),
        rows_json(comparison.rows), rows_json(comparison.peers));
}

void add_compare(CLI::App& app, int& exit_code) {
    struct Options {
        std::string base, head, fail_if, delta = "5%", only, expect;
        bool all = false, markdown = false, json = false, any_processor = false, counts = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* compare = app.add_subcommand(
        "compare", "compare the cells of two result files by paired rounds, with intervals");
    compare->add_option("base", options->base, "the result file to compare with")->required();
    compare->add_option("head", options->head, "the result file that is judged")->required();
    compare->add_option("--fail-if", options->fail_if,
                        "what counts as a regression, such as \"slower>5%\"; any verdict "
                        "\"slower\" if not given");
    CLI::Option* delta =
        compare->add_option("--delta", options->delta, "\"same\" means within this")
            ->capture_default_str();
    CLI::Option* counts =
        compare
            ->add_flag("--count", options->counts,
                       "compare counters instead of times, which no noise disturbs: work must be "
                       "equal or less, instructions (of boxwood sweep --count) and bytes at most 1 "
                       "% more, or as --fail-if \"more>1%\" says")
            ->excludes(delta);
    compare
        ->add_option("--expect", options->expect,
                     "of --count: a regex searched for in \"CELL COUNTER\"; what it finds may be "
                     "more")
        ->needs(counts);
    compare->add_option("--only", options->only, "cells whose name has a match of this regex");
    compare->add_flag("--all", options->all,
                      "every row, and the peers', which no gate looks at; else what changed");
    compare->add_flag("--any-processor", options->any_processor,
                      "compare the times of two processor models, too: else can't tell");
    CLI::Option* markdown =
        compare->add_flag("--markdown", options->markdown, "the table in Markdown");
    compare->add_flag("--json", options->json, "all of it as JSON")->excludes(markdown);
    compare->footer(
        "Example: boxwood compare base.h5 head.h5 --fail-if \"slower>5%\"\n"
        "Exit codes: 0 fine, 1 a regression, 2 bad input, 3 can't tell (too few or too noisy "
        "rounds, the head lacks what the base has, another processor, the peers changed too, or a "
        "file was changed after it was written).");
    compare->callback([options, &exit_code] {
        const Results base = read_results(options->base), head = read_results(options->head);
        const auto pattern = [](const std::string& text) {
            std::function<bool(const std::string&)> finds;
            if (!text.empty())
                finds = [regex = Pattern(text)](const std::string& name) {
                    return regex.is_in(name);
                };
            return finds;
        };
        if (options->counts) {
            CountOptions chosen;
            if (!options->fail_if.empty())
                chosen.more = fail_threshold(options->fail_if, "more");
            chosen.wanted = pattern(options->only);
            chosen.expected = pattern(options->expect);
            const CountComparison comparison = compare_counts(base, head, chosen);
            std::cout << (options->json ? counts_json(comparison)
                                        : counts_text(base, head, comparison, chosen,
                                                      {options->markdown, options->all}));
            exit_code = exit_code_of(comparison.gate);
            return;
        }
        FileOptions chosen;
        chosen.delta = percent_of(options->delta);
        chosen.any_processor = options->any_processor;
        if (!options->fail_if.empty())
            chosen.fail_if = fail_threshold(options->fail_if);
        chosen.wanted = pattern(options->only);
        const FileComparison comparison = compare_files(base, head, chosen);
        if (comparison.rows.empty() && comparison.lost.empty() &&
            (comparison.peers.empty() || !options->all))
            throw BadInput(fmt::format("compare: '{}' and '{}' have no timed cell of ours in "
                                       "common{}",
                                       options->base, options->head,
                                       options->only.empty() ? "" : " that --only leaves"));
        std::cout << (options->json ? comparison_json(base, head, comparison)
                                    : comparison_text(base, head, comparison, chosen,
                                                      {options->markdown, options->all}));
        exit_code = exit_code_of(comparison.gate);
    });
}

} // namespace boxwood::bench
