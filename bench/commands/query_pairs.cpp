/// `boxwood query pairs`: boxes in double, answers exact in double, by a tree of floats.
///
/// Each box is put into a float box f: down(min), up(max), then clamped to the finite floats. Both
/// maps are monotone, and down(x) <= up(x) for every x, so from a.min <= b.max in double follows
/// down(a.min) <= down(b.max) <= up(b.max): boxes that share a point share one as floats, also
/// those beyond the range of floats. So the tree misses no pair, and the comparison of the double
/// boxes drops the pairs that only the floats make. A layout of doubles finds no such pairs.

#include "bench/commands/command.h"
#include "bench/commands/query.h"
#include "bench/io/csv.h"
#include "kernels/arithmetic/rounding.h"
#include "trees/queries/filters.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <limits>

namespace boxwood::bench {
namespace {

constexpr CsvFormat box_format{"min_x,min_y,min_z,max_x,max_y,max_z", 6, 6};
constexpr std::array box_columns{"min_x", "min_y", "min_z", "max_x", "max_y", "max_z"};

std::vector<Aabb<double>> read_boxes(const std::string& path) {
    const std::string source = source_name(path);
    std::vector<Aabb<double>> boxes;
    read_csv(read_text(path), source, box_format, [&](std::span<const double> v, std::size_t line) {
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

Box to_float(const Aabb<double>& box) {
    constexpr float max_float = std::numeric_limits<float>::max();
    const Vec3<float> low{-max_float, -max_float, -max_float},
        high{max_float, max_float, max_float};
    const Box rounded = round_outward(box);
    return {min(max(rounded.min, low), high), min(max(rounded.max, low), high)};
}

/// Throws BadInput if that many pairs cannot be held: the list, and the parts it is joined from.
void require_memory(std::uint64_t pairs) {
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    const double have = static_cast<double>(pages) * static_cast<double>(page);
    const double need = static_cast<double>(pairs) * 2 * sizeof(Pair);
    if (need > have)
        throw BadInput(fmt::format("{} pairs overlap; listing them takes {:.0f} GB of memory, this "
                                   "machine has {:.0f}; --count only counts them",
                                   pairs, need * 1e-9, have * 1e-9));
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
    const BuildFunction build = chosen_builder(query.tree);
    const LayoutEntry& layout_entry = chosen_layout(query.tree);
    const std::unique_ptr<Executor> executor = chosen_executor(query.tree);
    const std::vector<Aabb<double>> boxes = read_boxes(query.boxes);

    std::vector<Box> float_boxes(boxes.size());
    std::transform(boxes.begin(), boxes.end(), float_boxes.begin(), to_float);
    Tree tree;
    const bool doubles = layout_entry.make_of_doubles != nullptr;
    const auto layout =
        doubles ? layout_entry.make_of_doubles(build(float_boxes, *executor), boxes, *executor)
                : make_layout(layout_entry, build, float_boxes, *executor, tree);
    const auto find_pairs = [&](PairSink& sink) {
        if (doubles) {
            layout->self_pairs(*executor, sink);
            return;
        }
        FilteredPairs exact([&](Pair p) { return overlaps(boxes[p.a], boxes[p.b]); }, sink);
        layout->self_pairs(*executor, exact);
    };

    // Counting first is cheap beside printing, and makes sure that the list will fit.
    CountPairs counter;
    find_pairs(counter);
    const std::string count = std::to_string(counter.count());

    std::vector<Pair> pairs;
    if (!query.count) {
        require_memory(counter.count());
        pairs.reserve(counter.count());
        AppendPairs append(pairs);
        find_pairs(append);
        std::sort(pairs.begin(), pairs.end());
    }

    BlockWriter text(out);
    if (query.format.json) {
        text << "{\"boxes\":" << std::to_string(boxes.size()) << ",\"count\":" << count;
        if (!query.count) {
            text << ",\"pairs\":[";
            print_json(pairs, text);
            text << "]";
        }
        text << "}\n";
        return;
    }
    if (query.format.header)
        text << (query.count ? "count\n" : "i,j\n");
    if (query.count)
        text << count << "\n";
    else
        print_lines(pairs, text);
}

void add_query_pairs(CLI::App& query) {
    auto options = std::make_shared<PairsQuery>();
    CLI::App* pairs = query.add_subcommand(
        "pairs", "every pair of boxes that share a point, as lines i,j with i < j, sorted");
    pairs->add_option("BOXES.csv", options->boxes, "the boxes; - reads standard input")->required();
    pairs->add_flag("--count", options->count, "print only how many pairs there are");
    add_format_options(*pairs, options->format);
    add_tree_options(*pairs, options->tree, "the answers are the same for every choice");
    pairs->footer(
        "Rows: min_x,min_y,min_z,max_x,max_y,max_z, decimal or hex float, read as doubles; blank\n"
        "lines and lines with # in front are skipped. Boxes are closed (one shared point\n"
        "counts) and numbered from 0. No pair is missed or added by rounding.\n\n"
        "Example, which prints 0,1:\n"
        "  printf '0,0,0,1,1,1\\n1,1,1,2,2,2\\n3,3,3,4,4,4\\n' | boxwood query pairs -");
    pairs->callback([options] { run(*options, std::cout); });
}

} // namespace boxwood::bench
