/// `boxwood query triangles`: pairs of triangles by any kernel.

#include "bench/commands/command.h"
#include "bench/commands/queries/query.h"
#include "bench/io/csv.h"
#include "bench/io/json.h"
#include "bench/io/say.h"
#include "bench/tasks/detail/pairs_on_device.h"
#include "kernels/oracle/registry.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iostream>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

template <class... Tuples> using Joined = decltype(std::tuple_cat(std::declval<Tuples>()...));
using TouchKernels =
    Joined<TriangleKernels, std::tuple<CertifiedF32>, oracle::RationalTriangleKernels>;
using AllDistanceKernels = Joined<DistanceKernels, std::tuple<CertifiedDistanceF32>,
                                  oracle::RationalTriangleDistanceKernels>;

constexpr CsvFormat triangle_pair_format{"ax,ay,az,bx,by,bz,cx,cy,cz of A, then the same of B", 18,
                                         18};

using TrianglePair = std::array<Triangle<double>, 2>;

std::vector<TrianglePair> read_pairs(const std::string& path) {
    const std::string source = source_name(path);
    std::vector<TrianglePair> pairs;
    read_csv_input(path, triangle_pair_format, [&](std::span<const double> v, std::size_t line) {
        for (std::size_t i = 0; i < v.size(); ++i)
            if (!std::isfinite(v[i]))
                throw_bad_row(
                    source, line,
                    fmt::format("number {} of the row is {}; triangles need finite numbers", i + 1,
                                v[i]));
        const auto corner = [&](std::size_t i) { return Vec3<double>{v[i], v[i + 1], v[i + 2]}; };
        pairs.push_back({{{corner(0), corner(3), corner(6)}, {corner(9), corner(12), corner(15)}}});
    });
    return pairs;
}

template <class Real> Triangle<Real> rounded(const Triangle<double>& t) {
    return {Vec3<Real>(t.a), Vec3<Real>(t.b), Vec3<Real>(t.c)};
}

template <class Kernels> std::vector<std::string_view> kernel_names() {
    return []<class... K>(std::type_identity<std::tuple<K...>>) {
        return std::vector<std::string_view>{K::name...};
    }(std::type_identity<Kernels>{});
}

/// Calls f with the kernel of that name. Throws BadInput, with a suggestion, if there is none.
template <class Kernels, class F>
void with_known_kernel(std::string_view what, const std::string& name, F f) {
    if (!with_kernel<Kernels>(name, f))
        throw BadInput(unknown_name(what, name, kernel_names<Kernels>()));
}

/// A maybe is printed as the promise allows: as no by a kernel that never answers a false yes.
std::string_view digit(Answer answer, Promise promise) {
    const bool read_as_yes = promise != Promise::never_false;
    return answer == Answer::yes || (answer == Answer::maybe && read_as_yes) ? "1" : "0";
}

/// What is printed before the answers.
template <class K> std::string head(const Format& format, std::size_t n, std::string_view columns) {
    if (format.json)
        return fmt::format("{{\"n\":{},\"kernel\":{},\"answers\":[", n, json_string(K::name));
    return format.header ? fmt::format("{}\n", columns) : "";
}

template <class K>
void answer_touch(std::span<const TrianglePair> pairs, const Format& format, BlockWriter& text) {
    std::vector<std::size_t> undecided;
    std::string tiers;
    text << head<K>(format, pairs.size(), "touch");
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        using Real = typename K::Real;
        const Decision v = K::intersect(rounded<Real>(pairs[i][0]), rounded<Real>(pairs[i][1]));
        if (v.answer == Answer::maybe)
            undecided.push_back(i);
        const std::string_view separator = i ? "," : "";
        if (format.json) {
            text << separator << digit(v.answer, K::info.promise);
            tiers += fmt::format("{}{}", separator, v.tier);
        } else {
            text << digit(v.answer, K::info.promise) << "\n";
        }
    }
    if (format.json)
        text << fmt::format("],\"undecided\":[{}],\"tiers\":[{}]}}\n", fmt::join(undecided, ","),
                            tiers);
    else if (!undecided.empty())
        say(fmt::format("{} of {} rows undecided by {}, printed as {}; the first is row {}\n",
                        undecided.size(), pairs.size(), K::name,
                        digit(Answer::maybe, K::info.promise), undecided.front() + 1));
}

std::string point(Vec3<double> p) {
    return fmt::format("[{},{},{}]", json_number(p.x), json_number(p.y), json_number(p.z));
}

template <class K>
void answer_distance(std::span<const TrianglePair> pairs, const Format& format, BlockWriter& text) {
    text << head<K>(format, pairs.size(), "distance,lo,hi");
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        using Real = typename K::Real;
        const Distance d = K::distance(rounded<Real>(pairs[i][0]), rounded<Real>(pairs[i][1]));
        if (format.json)
            text << fmt::format("{}{{\"distance\":{},\"lo\":{},\"hi\":{},\"point_a\":{},"
                                "\"point_b\":{},\"tier\":{}}}",
                                i ? "," : "", json_number(d.distance), json_number(d.lo),
                                json_number(d.hi), point(d.point_a), point(d.point_b), d.tier);
        else
            text << fmt::format("{},{},{}\n", d.distance, d.lo, d.hi);
    }
    if (format.json)
        text << "]}\n";
}

} // namespace

void run(const TrianglesQuery& query, std::ostream& out) {
    BlockWriter text(out);
    if (query.distance)
        with_known_kernel<AllDistanceKernels>(
            "triangle distance kernel", query.kernel.empty() ? "certified" : query.kernel,
            [&]<class K>(std::type_identity<K>) {
                answer_distance<K>(read_pairs(query.pairs), query.format, text);
            });
    else
        with_known_kernel<TouchKernels>(
            "triangle kernel", query.kernel.empty() ? "guigue_devillers_exact" : query.kernel,
            [&]<class K>(std::type_identity<K>) {
                answer_touch<K>(read_pairs(query.pairs), query.format, text);
            });
}

void add_query_triangles(CLI::App& query) {
    auto options = std::make_shared<TrianglesQuery>();
    CLI::App* triangles = query.add_subcommand(
        "triangles", "for each pair of triangles whether they touch, or how far apart they are");
    triangles->add_option("PAIRS.csv", options->pairs, "the pairs; - reads standard input")
        ->required();
    triangles->add_flag("--distance", options->distance,
                        "print distance,lo,hi instead: lo <= the true distance <= hi if the kernel "
                        "is certified or exact");
    triangles->add_option("--kernel", options->kernel,
                          "a kernel of `boxwood list kernels`, family triangle_triangle (default "
                          "guigue_devillers_exact) or triangle_distance (default certified)");
    add_format_options(*triangles, options->format);
    triangles->footer(
        "Rows: 18 numbers, three corners of A and three of B, decimal or hex float, read as "
        "doubles;\nblank lines and lines with # in front are skipped. Triangles are closed: a "
        "shared point\nis a touch, and the distance is then 0. They may be degenerate. Kernels in "
        "f32 round the\nnumbers to floats first. What a kernel leaves undecided is printed as its "
        "promise allows,\nand counted on stderr.\n\nExample, which prints 1:\n"
        "  echo 0,0,0,2,0,0,0,2,0,1,1,-1,1,1,1,3,1,0 | boxwood query triangles -");
    triangles->callback([options] { run(*options, std::cout); });
}

} // namespace boxwood::bench
