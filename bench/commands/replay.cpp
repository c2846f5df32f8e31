#include "bench/replay/replay.h"
#include "bench/analysis/statistics.h"
#include "bench/commands/command.h"
#include "bench/commands/option_ranges.h"
#include "bench/io/json.h"
#include "bench/io/pattern.h"
#include "bench/io/progress.h"
#include "bench/io/text_table.h"
#include "bench/replay/made_program.h"
#include "bench/running/interrupt.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <set>

namespace boxwood::bench {
namespace {

struct ReplayOptions {
    std::string file, only;
    MadeProgramOptions made;
    unsigned rounds = 9;
    double max_tests = 2e9;
    bool json = false;
};

/// Calls that a table shows as one column.
struct Column {
    std::string_view title;
    std::vector<recording::Call> calls;
};
const std::array<Column, 4>& columns() {
    using enum recording::Call;
    static const std::array<Column, 4> all = {
        Column{"register", {add, remove, clear, setup}},
        Column{"update", {update_all, update_some}},
        Column{"collide", {collide_self, collide_object, collide_others}},
        Column{"distance", {distance_self, distance_object, distance_others}}};
    return all;
}

double column_ns(const ReplayOutcome& outcome, const Column& column) {
    std::vector<double> by_round(outcome.total_ns.size(), 0.);
    for (const recording::Call call : column.calls)
        for (std::size_t round = 0; round < by_round.size(); ++round)
            by_round[round] += outcome.per_ns[static_cast<std::size_t>(call)][round];
    return median_interval(by_round).mid;
}

/// Its time over that of the first, round by round.
MedianInterval ratio(const ReplayOutcome& outcome, const ReplayOutcome& to) {
    std::vector<double> ratios;
    for (std::size_t round = 0; round < outcome.total_ns.size(); ++round)
        ratios.push_back(outcome.total_ns[round] / to.total_ns[round]);
    return median_interval(ratios);
}

/// "3 box, 2 mesh of 5,000 triangles"
std::string shapes_of(const RecordedProgram& program) {
    std::map<recording::Shape, std::size_t> kinds;
    std::set<std::uint64_t> seen;
    std::size_t triangles = 0;
    for (const RecordedProgram::Geometry& geometry : program.geometries)
        if (seen.insert(geometry.hash).second) {
            ++kinds[geometry.shape];
            triangles += geometry.n_triangles;
        }
    std::string text;
    for (const auto& [shape, n] : kinds)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n,
                            recording::shape_names[static_cast<std::size_t>(shape)]);
    if (triangles)
        text += fmt::format(", {} triangles", triangles);
    return text;
}

std::string calls_of(const RecordedProgram& program) {
    const bool was_run = std::ranges::any_of(
        program.calls, [](const RecordedProgram::Call& call) { return call.ns > 0; });
    std::vector<std::string> headings = {"call", ">calls"};
    if (was_run)
        headings.insert(headings.end(), {">pairs shown", ">time in the program"});
    TextTable table(headings);
    for (std::size_t what = 0; what < recording::call_names.size(); ++what) {
        std::size_t n = 0;
        std::uint64_t shown = 0;
        double ns = 0;
        for (const RecordedProgram::Call& call : program.calls)
            if (static_cast<std::size_t>(call.what) == what) {
                ++n;
                shown += call.shown;
                ns += call.ns;
            }
        if (n == 0)
            continue;
        std::vector<std::string> row = {std::string(recording::call_names[what]),
                                        fmt::format("{}", n)};
        if (was_run)
            row.insert(row.end(),
                       {is_query(static_cast<recording::Call>(what)) ? fmt::format("{}", shown)
                                                                     : std::string(),
                        time_text(ns)});
        table.add(row);
    }
    return table.text();
}

/// The queries of its callbacks about the shapes of pairs; empty if that is not known.
std::string requests_of(const RecordedProgram& program) {
    TextTable table({"queries of shapes", ">times", ">time in the program"});
    for (std::size_t i = 0; i < program.requests.size(); ++i) {
        double n = 0, ns = 0;
        for (const RecordedProgram::RequestCount& row : program.request_counts)
            if (row.request == i) {
                n += row.n;
                ns += row.ns;
            }
        const auto [question, max_contacts, contacts, points, is_signed] = program.requests[i];
        const std::string many =
            max_contacts < 1e9 ? fmt::format("at most {:.0f}", max_contacts) : std::string("all");
        table.add({question == 0 && contacts == 0 && max_contacts == 1 ? "do they touch"
                   : question == 0 ? fmt::format("do they touch, {} {}", many,
                                                 contacts != 0 ? "contacts" : "pairs of parts")
                                   : fmt::format("how far apart{}{}", points != 0 ? ", where" : "",
                                                 is_signed != 0 ? ", below 0 if they overlap" : ""),
                   fmt::format("{:.0f}", n), time_text(ns)});
    }
    return table.empty() ? "" : table.text() + "\n";
}

std::string answers_text(const ReplayOutcome& outcome, const ReplayOutcome& first,
                         std::size_t n_checked) {
    const std::string where = outcome.witness.empty() ? "" : ": " + outcome.witness;
    if (outcome.wrong)
        return fmt::format("{} WRONG, the first in call {}{}", outcome.wrong, outcome.first_wrong,
                           where);
    if (outcome.differ)
        return fmt::format("{} not as those of the first, from call {} on", outcome.differ,
                           outcome.first_differs);
    if (n_checked)
        return "right";
    return &outcome != &first ? "as those of the first" : "not checked";
}

/// Those with shapes, or those by bounds alone; each against the first of them.
std::string table_of(const ReplayReport& report, bool with_shapes) {
    std::vector<std::string> headings = {"manager", ">all"};
    for (const Column& column : columns())
        headings.push_back(">" + std::string(column.title));
    headings.insert(headings.end(), {">over the first", "answers"});
    TextTable table(headings);
    const ReplayOutcome* first = nullptr;
    for (const ReplayOutcome& outcome : report.outcomes) {
        if (outcome.has_shapes != with_shapes)
            continue;
        if (!first)
            first = &outcome;
        std::vector<std::string> row = {outcome.name,
                                        time_text(median_interval(outcome.total_ns).mid)};
        for (const Column& column : columns())
            row.push_back(time_text(column_ns(outcome, column)));
        const MedianInterval over = ratio(outcome, *first);
        row.push_back(&outcome == first ? "1"
                      : over.n < min_pairs_interval
                          ? ratio_text(over.mid)
                          : fmt::format("{} ({} to {})", ratio_text(over.mid), ratio_text(over.lo),
                                        ratio_text(over.hi)));
        row.push_back(answers_text(outcome, *first,
                                   with_shapes ? report.n_shapes_checked : report.n_checked));
        table.add(row);
    }
    return table.text();
}

std::string as_text(const ReplayOptions& options, const RecordedProgram& program,
                    const ReplayReport& report) {
    std::string text = fmt::format("{}: {} objects ({}), {} calls, numbers of {} bits\n\n{}\n{}",
                                   options.file.empty() ? "a made program" : options.file,
                                   program.n_objects(), shapes_of(program), program.calls.size(),
                                   program.bits, calls_of(program), requests_of(program));
    const auto rounds = report.outcomes.front().total_ns.size();
    if (!report.outcomes.front().has_shapes)
        text += fmt::format("Pairs alone: a callback takes note, and does no narrow phase (medians "
                            "of {} rounds in turns)\n{}\n",
                            rounds, table_of(report, false));
    if (report.outcomes.back().has_shapes)
        text += fmt::format("With the shapes: which pairs touch{}, and the least distance; objects "
                            "are moved within the time\n{}\n",
                            program.touch.contacts ? ", with their contacts" : "",
                            table_of(report, true));
    const auto checked = [&](std::size_t n, const char* how, bool are_more) {
        text +=
            fmt::format("{} of {} queries were checked by testing all {}{}.\n", n, report.n_queries,
                        how, are_more ? " (--max-tests 1e12 checks more)" : "");
    };
    checked(report.n_checked, "pairs of bounds", report.n_too_dear > 0);
    if (report.n_of_chance)
        text += fmt::format("{} are distances that the program ended: what they come to by bounds "
                            "depends on the order of pairs, and is not checked.\n",
                            report.n_of_chance);
    if (report.outcomes.back().has_shapes)
        checked(report.n_shapes_checked, "triangles of pairs that may touch, or be the nearest",
                report.n_shapes_too_dear > 0);
    if (!report.left_out.empty())
        text += fmt::format("Left out, as they do not come back from such a program (bounds or "
                            "poses beyond 1e18, SSaP from distances, Coal from bounds without "
                            "volume), or need shapes that are "
                            "not in it: {}.\n",
                            fmt::join(report.left_out, "; "));
    if (report.n_missed)
        text += fmt::format("THE PROGRAM'S OWN MANAGER MISSED PAIRS in {} of them, first in call "
                            "{}: bounds that overlap were not shown to its callback.\n",
                            report.n_missed, report.first_missed);
    return text;
}

std::string as_json(const RecordedProgram& program, const ReplayReport& report) {
    std::string outcomes;
    for (const ReplayOutcome& outcome : report.outcomes) {
        std::string parts;
        for (const Column& column : columns())
            parts += fmt::format(",{}:{}", json_string(std::string(column.title) + "_ns"),
                                 json_number(column_ns(outcome, column)));
        const auto first =
            std::ranges::find(report.outcomes, outcome.has_shapes, &ReplayOutcome::has_shapes);
        const MedianInterval over = ratio(outcome, *first);
        std::string rounds;
        for (const double ns : outcome.total_ns)
            rounds += (rounds.empty() ? "" : ",") + json_number(ns);
        outcomes += fmt::format(
            "{}{{\"manager\":{},\"shapes\":{},\"total_ns\":{}{},\"rounds_ns\":[{}],"
            "\"over_first\":{{\"mid\":{},\"lo\":{},\"hi\":{}}},\"wrong\":{},\"differ\":{},"
            "\"witness\":{}}}",
            outcomes.empty() ? "" : ",\n  ", json_string(outcome.name), outcome.has_shapes,
            json_number(median_interval(outcome.total_ns).mid), parts, rounds,
            json_number(over.mid), json_number(over.lo), json_number(over.hi), outcome.wrong,
            outcome.differ, json_string(outcome.witness));
    }
    return fmt::format("{{\"objects\":{},\"calls\":{},\"queries\":{},\"checked\":{},"
                       "\"shapes_checked\":{},\"missed\":{},\n \"managers\":[\n  {}]}}\n",
                       program.n_objects(), program.calls.size(), report.n_queries,
                       report.n_checked, report.n_shapes_checked, report.n_missed, outcomes);
}

std::vector<ReplayEntry> chosen_entries(const std::string& only) {
    std::vector<ReplayEntry> all = replay_entries();
    if (only.empty())
        return all;
    const Pattern pattern(only);
    std::string names;
    std::erase_if(all, [&](const ReplayEntry& entry) {
        if (!entry.is_truth)
            names += (names.empty() ? "" : ", ") + entry.name;
        return !entry.is_truth && !pattern.is_in(entry.name);
    });
    if (std::ranges::all_of(all, &ReplayEntry::is_truth))
        throw BadInput(fmt::format("--only \"{}\" leaves no manager of {}", only, names));
    return all;
}

ReplayReport replayed(const RecordedProgram& program, const std::vector<ReplayEntry>& entries,
                      const ReplayOptions& options) {
    Progress progress(stderr);
    Eta eta(2. + options.rounds * static_cast<double>(entries.size() - 1));
    const auto begun = std::chrono::steady_clock::now();
    std::string last;
    return replay(
        program, entries, options.rounds, options.max_tests, [&](const std::string& next) {
            const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begun;
            if (!last.empty() && next != last)
                eta.done(1);
            progress.show({"replaying", eta.fraction(),
                           last.empty() ? -1 : eta.left_s(elapsed.count()), next});
            last = next;
            return !CtrlC::pressed();
        });
}

int run(const ReplayOptions& options) {
    const std::vector<ReplayEntry> entries = chosen_entries(options.only);
    constexpr std::size_t max_queries = 10'000'000;
    if (options.made.distances > max_queries / options.made.frames)
        throw BadInput(fmt::format("--distances times --frames: at most {}", max_queries));
    const RecordedProgram program =
        options.file.empty() ? made_program(options.made) : read_program(options.file);
    if (program.calls.empty())
        throw BadInput(options.file + ": it holds no call; did the program call its recorder?");
    const CtrlC ctrl_c;
    const ReplayReport report = replayed(program, entries, options);
    if (report.outcomes.empty())
        throw BadInput(options.file +
                       ": it has shapes that are known by their bounds alone, and no "
                       "manager of FCL or Coal is here or chosen to run it with");
    if (report.outcomes.front().total_ns.empty())
        throw Interrupted("no round is complete");
    std::cout << (options.json ? as_json(program, report) : as_text(options, program, report));
    if (CtrlC::pressed())
        throw Interrupted(fmt::format("{} of {} rounds are complete",
                                      report.outcomes.front().total_ns.size(), options.rounds));
    const bool wrong = std::ranges::any_of(report.outcomes, [](const ReplayOutcome& outcome) {
        const bool is_peers = outcome.has_shapes && outcome.name != world_replay().name;
        return outcome.is_ours && !is_peers && outcome.wrong > 0;
    });
    return wrong ? exit_failed : exit_success;
}

} // namespace

void add_replay(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* command = app.add_subcommand(
        "replay",
        "run again the calls of a program to its FCL manager, with every manager there is");
    CLI::Option* const file = command->add_option(
        "recording", options->file,
        "a file that `boxwood record` or a recorder wrote; without it a program is made "
        "up: bodies drift, the pairs are queried frame by frame");
    command->add_option("--bodies", options->made.bodies, "of a made program")
        ->check(CLI::Range(std::size_t{1}, std::size_t{10'000'000}))
        ->excludes(file)
        ->capture_default_str();
    command
        ->add_option("--moved", options->made.moved,
                     "of a made program: the share of bodies that move in a frame")
        ->check(number_range(0, 1))
        ->excludes(file)
        ->capture_default_str();
    command
        ->add_option(
            "--triangles", options->made.triangles,
            "of a made program: triangles of the mesh that its bodies are copies of, turned "
            "at random; 0: they are boxes")
        ->check(CLI::Range(std::size_t{0}, std::size_t{1'000'000}))
        ->excludes(file)
        ->capture_default_str();
    command
        ->add_option("--distances", options->made.distances,
                     "of a made program: so many queries a frame for the distance of one body to "
                     "the nearest other")
        ->check(CLI::Range(std::size_t{0}, std::size_t{1'000'000}))
        ->excludes(file)
        ->capture_default_str();
    command->add_option("--frames", options->made.frames, "of a made program")
        ->check(CLI::Range(1, 10'000))
        ->excludes(file)
        ->capture_default_str();
    command->add_option("--only", options->only,
                        "only managers whose name this regular expression is found in");
    command->add_option("--rounds", options->rounds, "how often each runs")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command
        ->add_option("--max-tests", options->max_tests,
                     "check queries until so many pairs, of bounds or of triangles, are tested")
        ->check(number_range(0, 1e18))
        ->capture_default_str();
    command->add_flag("--json", options->json, "print one JSON object");
    command->footer(
        "To record, run your program as `boxwood record ./program`, or, if it uses FCL in\n"
        "floats or Coal, put a recorder before its manager:\n"
        "  #include <boxwood/trees/adapters/fcl_recorder.h>\n"
        "  boxwood::FclRecorder<double> recorder(manager, \"program.h5\");\n"
        "and call `recorder` where you called `manager`. Compile with FCL and HDF5.\n"
        "Examples:\n  boxwood replay program.h5\n"
        "  boxwood replay --bodies 10000 --moved 0.01\n"
        "  boxwood replay --bodies 1000 --triangles 1000 --distances 100\n"
        "  boxwood replay program.h5 --only 'boxwood|array' --rounds 21 --json\n"
        "Answers are held against a test of all pairs and, with shapes, against rational\n"
        "arithmetic on triangles; where that is not known, against one another.\n"
        "Exit codes: 0 done, 1 wrong answers of World, or wrong bounds of a manager of Boxwood's,\n"
        "2 no recording, 130 interrupted (what was done is printed).");
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace boxwood::bench
