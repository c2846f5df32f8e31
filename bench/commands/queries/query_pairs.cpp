/// `boxwood query pairs`: boxes in double, answers exact in double, by a tree of floats.
///
/// Each box is put into a float box f: down(min), up(max), then clamped to the finite floats. Both
/// maps are monotone, and down(x) <= up(x) for every x, so from a.min <= b.max in double follows
/// down(a.min) <= down(b.max) <= up(b.max): boxes that share a point share one as floats, also
/// those beyond the range of floats. So the tree misses no pair, and the comparison of the double
/// boxes drops the pairs that only the floats make. A layout of doubles finds no such pairs.

#include "bench/commands/command.h"
#include "bench/commands/devices.h"
#include "bench/commands/queries/query.h"
#include "bench/commands/queries/watched_pairs.h"
#include "bench/io/available_memory.h"
#include "bench/io/csv.h"
#include "bench/io/say.h"
#include "bench/running/interrupt.h"
#include "kernels/arithmetic/rounding.h"
#include "trees/queries/count_up_to.h"
#include "trees/queries/filters.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <limits>

namespace boxwood::bench {
namespace {

constexpr CsvFormat box_format{"min_x,min_y,min_z,max_x,max_y,max_z", 6, 6};
constexpr std::array box_columns{"min_x", "min_y", "min_z", "max_x", "max_y", "max_z"};

} // namespace

std::vector<Aabb<double>> read_boxes(const std::string& path) {
    const std::string source = source_name(path);
    std::vector<Aabb<double>> boxes;
    read_csv_input(path, box_format, [&](std::span<const double> v, std::size_t line) {
        for (std::size_t i = 0; i < 6; ++i)
            if (!std::isfinite(v[i]))
                throw_bad_row(
                    source, line,
                    fmt::format("{} is {}; a box needs finite numbers", box_columns[i], v[i]));
        for (std::size_t i = 0; i < 3; ++i)
            if (v[i] > v[i + 3])
                throw_bad_row(source, line,
                              fmt::format("{} {} is larger than {} {}; swap them", box_columns[i],
                                          v[i], box_columns[i + 3], v[i + 3]));
        boxes.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
    });
    return boxes;
}

Box rounded_to_floats(const Aabb<double>& box) {
    constexpr float max_float = std::numeric_limits<float>::max();
    const Vec3<float> low{-max_float, -max_float, -max_float},
        high{max_float, max_float, max_float};
    const Box rounded = round_outward(box);
    return {min(max(rounded.min, low), high), min(max(rounded.max, low), high)};
}

namespace {

/// The boxes of a query in a tree, which finds the pairs.
class PairFinder {
  public:
    explicit PairFinder(const PairsQuery& query) {
        DeviceBvhOptions device_options;
        const bool device = query.device.has_value();
        if (device)
            device_options.place.index = chosen_device(*query.device, devices(), why_no_device());
        const BuildFunction build = chosen_builder(query.tree);
        const LayoutEntry& layout = chosen_layout(query.tree);
        executor_ = chosen_executor(query.tree);
        boxes_ = read_boxes(query.boxes);
        std::vector<Box> float_boxes(boxes_.size());
        std::transform(boxes_.begin(), boxes_.end(), float_boxes.begin(), rounded_to_floats);
        if (device) {
            on_device_.emplace(float_boxes, device_options);
            return;
        }
        Tree tree;
        doubles_ = layout.make_of_doubles != nullptr;
        layout_ = doubles_
                      ? layout.make_of_doubles(build(float_boxes, *executor_), boxes_, *executor_)
                      : make_layout(layout, build, float_boxes, *executor_, tree);
    }
    std::size_t boxes() const { return boxes_.size(); }

    /// Into the sink, in an order that depends on the tree alone if `in_order`. Throws Interrupted
    /// at Ctrl-C; `found` says how much was found by then.
    void find(PairSink& sink, bool in_order, const char* stage,
              const std::function<std::string()>& found) const {
        const CtrlC ctrl_c;
        Progress progress(stderr);
        const auto search = [&](PairSink& to) {
            WatchedPairs watched(to, progress, stage, found);
            if (on_device_)
                on_device_->self_pairs(watched);
            else
                layout_->self_pairs(in_order ? serial() : *executor_, watched);
            if (CtrlC::pressed())
                throw Interrupted(
                    fmt::format("interrupted while {}, {}, after {:.0f} % of the work", stage,
                                found(), 100 * watched.fraction()));
        };
        if (doubles_)
            return search(sink);
        FilteredPairs exact([&](Pair p) { return overlaps(boxes_[p.a], boxes_[p.b]); }, sink);
        search(exact);
    }

  private:
    std::unique_ptr<Executor> executor_;
    std::vector<Aabb<double>> boxes_;
    std::unique_ptr<AnyLayout> layout_;
    std::optional<DeviceBvh> on_device_;
    bool doubles_ = false;
};

/// Counts, until there are more than `limit`.
std::uint64_t count_pairs(const PairFinder& finder, std::uint64_t limit, bool in_order) {
    CountPairsUpTo counter(limit);
    finder.find(counter, in_order, "counting",
                [&] { return fmt::format("{} pairs", counter.count()); });
    return counter.count();
}

/// The pairs in order, all or `limit` of them. Counting first is cheap beside printing, and makes
/// sure that the list fits. Throws BadInput if it does not.
std::vector<Pair> list_pairs(const PairFinder& finder, const PairsQuery& query, bool& complete) {
    const std::optional<std::uint64_t> limit = query.limit;
    const std::uint64_t memory = query.max_bytes ? *query.max_bytes : available_memory();
    const std::uint64_t most = memory / (2 * sizeof(Pair)); // the list, and parts it is joined from
    const std::uint64_t enough = std::min(most, limit.value_or(most));
    const std::uint64_t count = count_pairs(finder, enough, limit.has_value());
    complete = count <= enough;
    if (!complete && enough == most && limit != most)
        throw BadInput(fmt::format("more than {} pairs overlap, and to list them takes more than "
                                   "the {:.1f} GB of memory that are available; --count counts "
                                   "them, {} prints some of them",
                                   most, static_cast<double>(memory) * 1e-9,
                                   limit ? "a smaller --limit" : "--limit N"));
    std::vector<Pair> pairs;
    pairs.reserve(std::min(count, enough));
    const auto found = [&] { return fmt::format("{} pairs", pairs.capacity()); };
    if (complete) {
        AppendPairs append(pairs);
        finder.find(append, limit.has_value(), "listing", found);
    } else {
        ForEachPair first([&](Pair pair) {
            pairs.push_back(pair);
            return pairs.size() < enough;
        });
        finder.find(first, true, "listing", found);
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

void print_lines(const std::vector<Pair>& pairs, BlockWriter& text) {
    for (const Pair p : pairs)
        text << p.a << "," << p.b << "\n";
}

void print_json(const std::vector<Pair>& pairs, BlockWriter& text) {
    std::string_view separator = "";
    for (const Pair p : pairs) {
        text << separator << "[" << p.a << "," << p.b << "]";
        separator = ",";
    }
}

} // namespace

void run(const PairsQuery& query, std::ostream& out) {
    const PairFinder finder(query);

    std::vector<Pair> pairs;
    std::uint64_t count = 0;
    bool complete = true;
    if (query.count) {
        count = count_pairs(finder, std::numeric_limits<std::uint64_t>::max(), false);
    } else {
        pairs = list_pairs(finder, query, complete);
        count = pairs.size();
    }

    BlockWriter text(out);
    if (query.format.json) {
        text << "{\"boxes\":" << std::to_string(finder.boxes())
             << ",\"count\":" << std::to_string(count);
        if (query.limit)
            text << ",\"complete\":" << (complete ? "true" : "false");
        if (!query.count) {
            text << ",\"pairs\":[";
            print_json(pairs, text);
            text << "]";
        }
        text << "}\n";
    } else {
        if (query.format.header)
            text << (query.count ? "count\n" : "i,j\n");
        if (query.count)
            text << std::to_string(count) << "\n";
        else
            print_lines(pairs, text);
    }
    if (!complete)
        say(fmt::format("boxwood: stopped at {} pairs (--limit); there are more, and --count says "
                        "how many\n",
                        count));
}

void add_query_pairs(CLI::App& query) {
    auto options = std::make_shared<PairsQuery>();
    CLI::App* pairs = query.add_subcommand(
        "pairs", "every pair of boxes that share a point, as lines i,j with i < j, sorted");
    pairs->add_option("BOXES.csv", options->boxes, "the boxes; - reads standard input")->required();
    auto* count = pairs->add_flag("--count", options->count, "print only how many pairs there are");
    pairs
        ->add_option("--limit", options->limit,
                     "print at most so many pairs, the first that are found, on one thread: which "
                     "ones depends on the builder and layout")
        ->check([](const std::string& text) { // -1 would be read as 2^64 - 1
            return text.starts_with('-') ? "must be 1 or more, not " + text : "";
        })
        ->check(CLI::Range(std::uint64_t{1}, std::numeric_limits<std::uint64_t>::max()))
        ->excludes(count);
    add_format_options(*pairs, options->format);
    add_tree_options(*pairs, options->tree, "the answers are the same for every choice");
    CLI::Option* const device =
        pairs->add_option("--device", options->device,
                          "a name of `boxwood list devices`: that GPU finds the pairs, with a tree "
                          "of its own; the answers are the same");
    for (const char* of_the_host : {"--builder", "--layout", "--executor", "--threads"})
        device->excludes(pairs->get_option(of_the_host));
    pairs->footer(
        "Rows: min_x,min_y,min_z,max_x,max_y,max_z, decimal or hex float, read as doubles; blank\n"
        "lines and lines with # in front are skipped. Boxes are closed (one shared point\n"
        "counts) and numbered from 0. No pair is missed or added by rounding. A list that does\n"
        "not fit in memory is an error, which comes before anything is printed.\n\n"
        "Example, which prints 0,1:\n"
        "  printf '0,0,0,1,1,1\\n1,1,1,2,2,2\\n3,3,3,4,4,4\\n' | boxwood query pairs -");
    pairs->callback([options] { run(*options, std::cout); });
}

} // namespace boxwood::bench
