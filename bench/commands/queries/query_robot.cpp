/// `boxwood query robot`: self-collision of a robot that a URDF file describes.

#include "bench/commands/command.h"
#include "bench/commands/option_ranges.h"
#include "bench/commands/queries/bodies.h"
#include "bench/commands/queries/query.h"
#include "bench/commands/queries/robot_case.h"
#include "bench/commands/queries/robot_picture.h"
#include "bench/commands/queries/robot_printer.h"
#include "bench/commands/queries/surroundings.h"
#include "bench/io/say.h"
#include "bench/io/write_file.h"
#include "kernels/primitives/coordinate_limit.h"
#include "kernels/suggest.h"
#include "scenes/robots/random_values.h"
#include "scenes/robots/srdf.h"
#include "scenes/robots/urdf.h"
#include "scenes/text/read_file.h"
#include "trees/world/propose_pairs.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>

namespace boxwood::bench {
namespace {

/// What no SRDF file says: adjacent links, and what samples show.
void propose_allowed(const RobotQuery& query, const LinkNarrowPhase& narrow_phase,
                     RobotCase& robot) {
    if (!query.files.srdf) {
        const std::size_t n = allow_adjacent(robot.robot, robot.allowed);
        say(fmt::format("boxwood: no --srdf: {} pairs of adjacent links are allowed to collide{}\n",
                        n, query.samples ? "" : "; --samples N proposes more"));
    } else if (robot.allowed.pairs().empty() && !query.samples) {
        say(fmt::format("boxwood: {} allows no pair to collide, not even adjacent links; without "
                        "--srdf those are allowed, and --samples N proposes more\n",
                        *query.files.srdf));
    }
    if (query.samples) {
        const auto draw = [&](std::uint64_t i, std::span<double> values) {
            random_values(robot.robot.ranges(), query.seed, i, values);
        };
        const auto collide = [&](std::uint32_t a, std::uint32_t b, auto poses) {
            return narrow_phase.collide(a, b, poses);
        };
        const PairsBySampling found = allow_by_samples(
            robot.robot, robot.boxes, {*query.samples, query.seed, draw}, collide, robot.allowed);
        say(fmt::format("boxwood: of {} samples (seed {}): {} pairs always collide, {} cannot, {} "
                        "were never seen to, which proves nothing\n",
                        *query.samples, query.seed, found.always, found.never, found.sampled));
    }
}

void write_allowed(const RobotQuery& query, const RobotCase& robot) {
    const std::string original = query.files.srdf ? read_file(*query.files.srdf, "SRDF") : "";
    write_file(*query.write_srdf,
               srdf_text(robot.robot.description(), robot.allowed.pairs(), original),
               "--write-srdf " + *query.write_srdf);
}

double joint_value(std::string_view item, std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        throw BadInput(fmt::format("--joints: '{}' is no NAME=NUMBER; write "
                                   "\"NAME=NUMBER,NAME=NUMBER\", radians or metres",
                                   item));
    if (!(std::abs(value) < coordinate_limit))
        throw BadInput(fmt::format("--joints: {} is beyond 2^60", item));
    return value;
}

/// "name=value,name=value"; the joints that are not named keep their values.
void take_joints(const Robot& robot, std::string_view text, std::vector<double>& values) {
    std::vector<std::size_t> named;
    while (!text.empty()) {
        const std::string_view item = text.substr(0, text.find(','));
        text.remove_prefix(std::min(item.size() + 1, text.size()));
        const std::size_t equals = item.rfind('=');
        const std::string_view name = item.substr(0, equals);
        const double value = joint_value(item, equals == item.npos ? "" : item.substr(equals + 1));
        const std::size_t at = robot.value(name);
        if (std::ranges::find(named, at) != named.end())
            throw BadInput(fmt::format("--joints: {} is named twice", name));
        named.push_back(at);
        values[at] = value;
    }
}

/// Values of joints that mimic others or are fixed say nothing new.
void take_named_state(const RobotCase& robot, const std::string& name,
                      std::vector<double>& values) {
    const Srdf::State& state =
        entry_named(name, std::span<const Srdf::State>(robot.named_states), "state");
    const auto joints = robot.robot.kinematics().joints_of_values();
    for (const auto& [joint, value] : state.values)
        if (const auto at = std::ranges::find(joints, joint); at != joints.end())
            values[static_cast<std::size_t>(at - joints.begin())] = value;
}

/// The only state that is asked about, if they are not random.
std::vector<double> chosen_state(const RobotQuery& query, const RobotCase& robot) {
    std::vector<double> values = robot.robot.rest();
    if (query.state)
        take_named_state(robot, *query.state, values);
    if (query.joints)
        take_joints(robot.robot, *query.joints, values);
    for (const JointDescription& joint : robot.robot.joints()) {
        const bool has_limits =
            joint.kind == JointKind::revolute || joint.kind == JointKind::prismatic;
        if (!has_limits || joint.mimic)
            continue;
        const double value = values[robot.robot.value(joint.name)];
        if (value < joint.lower || value > joint.upper)
            fmt::print(stderr, "boxwood: warning: {} is {}, outside its limits {} to {}\n",
                       joint.name, value, joint.lower, joint.upper);
    }
    return values;
}

/// Calls f(i, time) once `values` are those of state i.
template <class F>
void for_each_state(const RobotQuery& query, const Robot& robot, std::vector<double>& values,
                    const F& f) {
    if (!query.random)
        return f(std::uint64_t{0}, 0.0);
    if (!query.steps) {
        for (std::uint64_t i = 0; i < *query.random; ++i) {
            random_values(robot.ranges(), query.seed, i, values);
            f(i, static_cast<double>(i));
        }
        return;
    }
    std::vector<std::vector<double>> waypoints(*query.random, values);
    for (std::uint64_t i = 0; i < waypoints.size(); ++i)
        random_values(robot.ranges(), query.seed, i, waypoints[i]);
    const JointPath path(robot, std::move(waypoints));
    const std::uint64_t steps = *query.steps;
    for (std::uint64_t i = 0; i <= (path.size() - 1) * steps; ++i) {
        const double time = static_cast<double>(i) / static_cast<double>(steps);
        path.at(time, values);
        f(i, time);
    }
}

std::uint64_t number_of_states(const RobotQuery& query) {
    const std::uint64_t n = query.random.value_or(1);
    return query.steps ? (n - 1) * *query.steps + 1 : n;
}

void write_picture(const std::string& name, const std::string& robot,
                   const std::vector<LeastOfState>& least) {
    if (least.empty())
        throw BadInput("--svg: no two links can collide, so there is no distance to draw");
    write_file(name, robot_picture(robot, least), "--svg " + name);
}

} // namespace

void run(const RobotQuery& query, const MakeLinkNarrowPhase& make_narrow_phase, std::ostream& out) {
    try {
        if (query.state && !query.files.srdf)
            throw BadInput("--state names a state of an SRDF file; give one by --srdf");
        QueryTimes times(query.times);
        const std::unique_ptr<RobotCase> robot =
            times.reading([&] { return read_robot(query.files); });
        const std::unique_ptr<LinkNarrowPhase> narrow_phase = times.building(
            [&] { return make_narrow_phase(robot->robot, robot->meshes, query.files.are_solid); });
        propose_allowed(query, *narrow_phase, *robot);
        const AllowedByUser allowed(query.allow, query.obstacles, *robot);
        if (query.write_srdf)
            write_allowed(query, *robot);
        std::vector<double> values = chosen_state(query, *robot);
        RobotSelfCollision self(robot->robot, robot->boxes, robot->allowed, *narrow_phase);
        std::optional<Surroundings> around;
        if (!query.obstacles.empty())
            around.emplace(*robot, allowed, query.files, times);
        const std::unique_ptr<RobotPrinter> printer = make_robot_printer(*robot, query.format, out);
        printer->begin();
        std::vector<LeastOfState> least;
        const double share = 1 / static_cast<double>(number_of_states(query));
        for_each_state(query, robot->robot, values, [&](std::uint64_t i, double time) {
            const SelfCollision* found = nullptr;
            const auto of_obstacles = times.answering(
                [&]() -> std::optional<Surroundings::Answer> {
                    found = &self.check(values);
                    return around ? std::optional(around->answer(values)) : std::nullopt;
                },
                share);
            printer->state(i, values, *found, of_obstacles ? &*of_obstacles : nullptr);
            if (query.svg && found->nearest)
                least.push_back({time, found->least, !found->colliding.empty()});
        });
        printer->end(times);
        if (query.svg)
            write_picture(*query.svg, robot->robot.name(), least);
    } catch (...) {
        rethrow_as_bad_input();
    }
}

void add_query_robot(CLI::App& query, MakeLinkNarrowPhase narrow_phase) {
    auto options = std::make_shared<RobotQuery>();
    CLI::App* robot = query.add_subcommand(
        "robot", "self-collision of a robot: links, candidate pairs, pairs that collide, distance");
    add_robot_options(*robot, options->files);
    auto* joints = robot->add_option("--joints", options->joints,
                                     "\"NAME=VALUE,...\", radians or metres; the others at rest, "
                                     "which is 0, or as near to it as their limits allow");
    auto* state = robot->add_option("--state", options->state, "a state of the SRDF file");
    auto* random = robot
                       ->add_option("--random", options->random,
                                    "so many states at random within the limits instead")
                       ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{10'000'000}))
                       ->excludes(joints)
                       ->excludes(state);
    robot
        ->add_option("--steps", options->steps,
                     "go from each random state to the next in so many steps, joints in proportion")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000}))
        ->needs(random);
    robot->add_option("--svg", options->svg, "draw the least distance over time, with its interval")
        ->needs(random);
    robot->add_option("--seed", options->seed, "of --random and --samples")
        ->check(seed_range())
        ->capture_default_str();
    robot
        ->add_option("--samples", options->samples,
                     "allow pairs, too, that collide in all of so many random states, or in none")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}));
    robot->add_option("--write-srdf", options->write_srdf,
                      "write the allowed pairs, with what --srdf holds else, as an SRDF file");
    robot->add_option("--obstacle", options->obstacles, obstacle_form);
    robot->add_option("--allow", options->allow,
                      "LINK,LINK or LINK,OBSTACLE: the two may touch; an obstacle by its NAME, or "
                      "as it is written; may be repeated");
    add_times_option(*robot, options->times);
    add_format_options(*robot, options->format);
    robot->footer(
        body_forms() +
        "Each line begins with what it is: link, joint, allowed, and for each state value,\n"
        "candidate (boxes of the links overlap), filtered (those that are not allowed), "
        "colliding,\n"
        "least (the least distance of links that are not allowed, 0 if two collide: the true one\n"
        "lies between lo and hi); with --obstacle, hit (a link touches one) and clearance (the "
        "least\n"
        "distance of a link and an obstacle). --times is of a state. Without --srdf adjacent links "
        "are allowed to "
        "collide.\n\n"
        "Examples:\n"
        "  boxwood query robot panda.urdf --srdf panda.srdf --joints \"panda_joint4=-2.3\"\n"
        "  boxwood query robot z1.urdf --samples 10000 --write-srdf z1.srdf --random 100 --seed 1\n"
        "  boxwood query robot panda.urdf --random 8 --steps 50 --svg least.svg\n"
        "  boxwood query robot panda.urdf --obstacle table=box:2,2,.1@0,0,-.05 --obstacle "
        "shelf.obj "
        "\\\n"
        "    --allow panda_link0,table");
    robot->callback([options, narrow_phase = std::move(narrow_phase)] {
        run(*options, narrow_phase, std::cout);
    });
}

} // namespace boxwood::bench
