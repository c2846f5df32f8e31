/// `boxwood query continuous`: when two moving meshes or primitives first touch.

#include "bench/commands/command.h"
#include "bench/commands/queries/bodies.h"
#include "bench/commands/queries/body_pair.h"
#include "bench/commands/queries/query.h"
#include "bench/io/json.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <iostream>
#include <limits>

namespace boxwood::bench {

void run(const ContinuousQuery& query, std::ostream& out) {
    const MotionPath kind = query.motion == "screw" ? MotionPath::screw : MotionPath::linear;
    const auto path = [&](const std::string& from, const std::string& to, const char* side) {
        const Pose start = read_pose(from, fmt::format("--from-{}", side));
        // A body without an end stays.
        return BodyPair::Path{start,
                              to.empty() ? start : read_pose(to, fmt::format("--to-{}", side))};
    };
    const BodyPair::Path path_a = path(query.from_a, query.to_a, "a");
    const BodyPair::Path path_b = path(query.from_b, query.to_b, "b");
    QueryTimes times(query.times);
    const BodyPair pair(query.a, query.b, {query.solid, query.bad_triangles, query.volume, &times});
    const FirstContact first =
        times.answering([&] { return pair.first_contact(path_a, path_b, kind); });
    const bool hit = first.hit != Answer::no; // left open: on the safe side
    const double t_hit =
        first.hit == Answer::maybe ? std::numeric_limits<double>::quiet_NaN() : first.t_hit;
    if (query.format.json) {
        out << fmt::format("{{\"hit\":{},\"t_free\":{},\"t_hit\":{}{}}}\n", hit ? "true" : "false",
                           json_number(first.t_free), json_number(t_hit), times.json());
    } else {
        out << (query.format.header ? "hit,t_free,t_hit\n" : "")
            << fmt::format("{},{},{}\n", hit ? 1 : 0, first.t_free, t_hit);
        times.report();
    }
}

void add_query_continuous(CLI::App& query) {
    auto options = std::make_shared<ContinuousQuery>();
    CLI::App* command =
        query.add_subcommand("continuous", "when two moving meshes or primitives first touch");
    command->add_option("A", options->a, body_form)->required();
    command->add_option("B", options->b, "another, or the same")->required();
    command->add_option("--from-a", options->from_a,
                        "where A starts: 16 numbers, a 4 x 4 matrix row by row");
    command->add_option("--to-a", options->to_a, "where A ends; where it starts if not given");
    command->add_option("--from-b", options->from_b, "where B starts");
    command->add_option("--to-b", options->to_b, "where B ends");
    command
        ->add_option("--motion", options->motion,
                     "linear: origins on straight lines, turning at constant rates; screw: about "
                     "one axis and along it")
        ->check(CLI::IsMember({"linear", "screw"}))
        ->capture_default_str();
    command->add_flag("--solid", options->solid,
                      "closed meshes are solids: what begins inside one touches it at time 0");
    add_bad_triangles_option(*command, options->bad_triangles);
    add_volume_option(*command, options->volume);
    add_times_option(*command, options->times);
    add_format_options(*command, options->format);
    command->footer(
        body_forms() +
        "Prints hit,t_free,t_hit: up to t_free they do not touch, whatever is thin; at t_hit they "
        "do, within 2^-36 of\ntheir size, or, of cylinders and other curved shapes, within what "
        "bounds of their distance leave open; nan (JSON: null) where it is left open whether they "
        "touch at all.\nt goes from 0 to 1.\n\nExample, which prints "
        "1,0.45,0.45 but for rounding:\n  boxwood query continuous box:.1,.1,.1 box:.1,1,1 "
        "--from-a "
        "\"1 0 0 -1 0 1 0 0 0 0 1 0 0 0 0 1\" --to-a \"1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1\"");
    command->callback([options] { run(*options, std::cout); });
}

} // namespace boxwood::bench
