/// `boxwood query ccd`: continuous collision of vertex-face or edge-edge pairs in linear motion.

#include "bench/commands/command.h"
#include "bench/commands/queries/query.h"
#include "bench/io/ccd_file.h"
#include "bench/io/csv.h"
#include "kernels/oracle/rational.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace boxwood::bench {
namespace {

using Kernels = decltype(std::tuple_cat(std::declval<ContinuousKernels>(),
                                        std::tuple<oracle::ExactContinuous>{}));

template <class Kernel> Kernel with_settings(const CcdQuery& query) {
    Kernel kernel;
    constexpr bool has_settings = requires { kernel.max_checks; };
    if constexpr (has_settings) {
        if (query.tolerance)
            kernel.tolerance = *query.tolerance;
        if (query.max_checks)
            kernel.max_checks = *query.max_checks;
    } else if (query.tolerance || query.max_checks) {
        throw BadInput(fmt::format("{} is a setting of --kernel {}; the kernel '{}' has none",
                                   query.tolerance ? "--tolerance" : "--max-checks",
                                   TightInclusion::name, Kernel::name));
    }
    return kernel;
}

/// The exact kernel reads the rational points as they are, the others doubles.
template <class Kernel>
Answer answer_of(const Kernel& kernel, bool is_face, const CcdFileQuery& query,
                 const std::string& source) {
    if constexpr (std::is_same_v<Kernel, oracle::ExactContinuous>) {
        return (is_face ? oracle::vertex_face(query.motion) : oracle::edge_edge(query.motion))
            .answer;
    } else {
        const LinearMotion motion = exact_doubles(query, source);
        return (is_face ? kernel.vertex_face(motion) : kernel.edge_edge(motion)).answer;
    }
}

/// Whether the query is about a vertex and a face.
bool is_vertex_face(const std::string& kind) {
    constexpr std::array<std::string_view, 2> kinds{"vertex-face", "edge-edge"};
    if (std::ranges::find(kinds, kind) == kinds.end())
        throw BadInput(unknown_name("kind of query", kind, kinds));
    return kind == kinds[0];
}

} // namespace

void run(const CcdQuery& query, std::ostream& out) {
    const bool is_face = is_vertex_face(query.kind);
    if (query.tolerance && !(*query.tolerance >= 0))
        throw BadInput(fmt::format("--tolerance is {}; it must be 0 or more", *query.tolerance));
    std::vector<std::uint8_t> answers;
    std::size_t false_positives = 0, false_negatives = 0;
    const bool known = with_kernel<Kernels>(query.kernel, [&]<class K>(std::type_identity<K>) {
        const K kernel = with_settings<K>(query);
        const std::string source = source_name(query.queries);
        for (const CcdFileQuery& row : read_ccd_queries(read_text(query.queries), source)) {
            // A maybe is never a miss.
            const bool touches = answer_of(kernel, is_face, row, source) != Answer::no;
            answers.push_back(touches);
            false_positives += touches && !row.touches;
            false_negatives += !touches && row.touches;
        }
    });
    if (!known) {
        const auto known_names = []<class... K>(std::type_identity<std::tuple<K...>>) {
            return std::array<std::string_view, sizeof...(K)>{K::name...};
        }(std::type_identity<Kernels>{});
        throw BadInput(unknown_name("continuous kernel", query.kernel, known_names));
    }

    BlockWriter text(out);
    if (!query.format.json) {
        if (query.format.header)
            text << "touch\n";
        for (const std::uint8_t touches : answers)
            text << (touches != 0 ? "1\n" : "0\n");
        return;
    }
    text << fmt::format("{{\"n\":{},\"false_positives\":{},\"false_negatives\":{},\"answers\":[",
                        answers.size(), false_positives, false_negatives);
    for (std::size_t i = 0; i < answers.size(); ++i)
        text << (i == 0 ? "" : ",") << (answers[i] != 0 ? "1" : "0");
    text << "]}\n";
}

void add_query_ccd(CLI::App& query) {
    auto options = std::make_shared<CcdQuery>();
    CLI::App* ccd = query.add_subcommand(
        "ccd", "whether moving vertices and faces, or edges, touch: 0 or 1 for each query");
    ccd->add_option("QUERIES.csv", options->queries, "the queries; - reads standard input")
        ->required();
    ccd->add_option("--kind", options->kind, "vertex-face or edge-edge")->required();
    ccd->add_option("--kernel", options->kernel,
                    "a vertex_face or edge_edge kernel of `boxwood list kernels`")
        ->capture_default_str();
    ccd->add_option(
        "--tolerance", options->tolerance,
        "tight_inclusion: features nearer than this part of the query's size count as touching "
        "(default 1e-6)");
    ccd->add_option(
        "--max-checks", options->max_checks,
        "tight_inclusion: most interval checks, after which it says 1 (default 100000)");
    add_format_options(*ccd, options->format);
    ccd->footer(
        "Rows: x_num,x_den,y_num,y_den,z_num,z_den,truth, whole numbers of any size; 8 rows a\n"
        "query: four points at t = 0, then the same four at t = 1, each moving on a straight "
        "line.\n"
        "vertex-face: the vertex, then the corners of the face. edge-edge: the ends of one edge,\n"
        "then those of the other. Closed: one shared point at one time counts. The truth, 0 or 1,\n"
        "is only compared: --json counts the differences. tight_inclusion says 1 where it cannot\n"
        "tell; it and cubic_f64 need coordinates that are doubles.\n\n"
        "Example, a vertex that falls onto a face at rest, which prints 1:\n"
        "  f='0,1,0,1,0,1,1 1,1,0,1,0,1,1 0,1,1,1,0,1,1'\n"
        "  printf '%s\\n' 1,4,1,4,1,1,1 $f 1,4,1,4,0,1,1 $f | boxwood query ccd - --kind "
        "vertex-face");
    ccd->callback([options] { run(*options, std::cout); });
}

} // namespace boxwood::bench
