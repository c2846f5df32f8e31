/// `boxwood query robot`: self-collision of a robot that a URDF file describes.

#include "bench/commands/command.h"
#include "bench/commands/queries/query.h"
#include "bench/io/json.h"
#include "bench/io/say.h"
#include "kernels/suggest.h"
#include "scenes/robots/random_values.h"
#include "scenes/robots/srdf.h"
#include "scenes/robots/urdf.h"
#include "scenes/text/read_file.h"
#include "trees/world/propose_pairs.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <iostream>

namespace boxwood::bench {
namespace {

/// The robot of a query, and all that is asked about it.
struct RobotCase {
    Robot robot;
    std::vector<TriangleMesh> meshes;
    LinkBoxes boxes;
    AllowedPairs allowed;
    std::vector<Srdf::State> named_states;

    RobotCase(UrdfRobot read, std::span<const Aabb<float>> mesh_boxes)
        : robot(std::move(read.description)), meshes(std::move(read.meshes)),
          boxes(robot, mesh_boxes), allowed(no_allowed_pairs(robot)) {}
};

std::unique_ptr<RobotCase> read_robot(const RobotQuery& query) {
    UrdfRobot read = read_urdf(query.urdf, query.package_paths);
    std::vector<Aabb<float>> mesh_boxes(read.meshes.size());
    for (std::size_t i = 0; i < read.meshes.size(); ++i)
        for (std::size_t t = 0; t < read.meshes[i].triangles.size(); ++t)
            mesh_boxes[i].extend(read.meshes[i].triangle(t).bounds());
    auto robot = std::make_unique<RobotCase>(std::move(read), mesh_boxes);
    if (query.srdf) {
        Srdf srdf = read_srdf(*query.srdf, robot->robot.description());
        for (AllowedPair& pair : srdf.allowed)
            robot->allowed.allow(pair.a, pair.b, pair.reason, std::move(pair.note));
        robot->named_states = std::move(srdf.states);
    }
    if (robot->boxes.links().empty())
        say(fmt::format("boxwood: no link of {} has a <collision> element, and <visual> ones are "
                        "not read: nothing can collide\n",
                        query.urdf));
    return robot;
}

/// What no SRDF file says: adjacent links, and what samples show.
void propose_allowed(const RobotQuery& query, const LinkNarrowPhase& narrow_phase,
                     RobotCase& robot) {
    if (!query.srdf) {
        const std::size_t n = allow_adjacent(robot.robot, robot.allowed);
        say(fmt::format("boxwood: no --srdf: {} pairs of adjacent links are allowed to collide{}\n",
                        n, query.samples ? "" : "; --samples N proposes more"));
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
    const std::string original = query.srdf ? read_file(*query.srdf, "SRDF") : "";
    std::ofstream file(*query.write_srdf, std::ios::binary);
    file << srdf_text(robot.robot.description(), robot.allowed.pairs(), original);
    file.close();
    if (!file)
        throw BadInput(fmt::format("--write-srdf {}: cannot be written", *query.write_srdf));
}

double joint_value(std::string_view item, std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        throw BadInput(fmt::format("--joints: '{}' is no NAME=NUMBER; write "
                                   "\"NAME=NUMBER,NAME=NUMBER\", radians or metres",
                                   item));
    return value;
}

/// "name=value,name=value"; the joints that are not named keep their values.
void take_joints(const Robot& robot, std::string_view text, std::vector<double>& values) {
    while (!text.empty()) {
        const std::string_view item = text.substr(0, text.find(','));
        text.remove_prefix(std::min(item.size() + 1, text.size()));
        const std::size_t equals = item.rfind('=');
        const std::string_view name = item.substr(0, equals);
        const double value = joint_value(item, equals == item.npos ? "" : item.substr(equals + 1));
        values[robot.value(name)] = value;
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
    return values;
}

class RobotPrinter {
  public:
    RobotPrinter(const RobotCase& robot, std::ostream& out) : robot_(robot), text_(out) {}
    virtual ~RobotPrinter() = default;
    virtual void begin() = 0;
    virtual void state(std::size_t i, std::span<const double> values,
                       const SelfCollision& found) = 0;
    virtual void end() {}

  protected:
    const std::string& link(std::uint32_t i) const { return robot_.robot.links()[i].name; }

    const RobotCase& robot_;
    BlockWriter text_;
};

/// One line per item, which begins with what it is.
class RobotLines final : public RobotPrinter {
  public:
    RobotLines(const RobotCase& robot, bool header, std::ostream& out)
        : RobotPrinter(robot, out), header_(header) {}

    void begin() override {
        const Robot& robot = robot_.robot;
        if (header_)
            text_ << "link,name,parent,geometries\njoint,name,type,lower,upper\n"
                     "allowed,link,link,reason\nvalue,state,joint,value\n"
                     "candidate,state,link,link\nfiltered,state,link,link\n"
                     "colliding,state,link,link\nleast,state,link,link,distance,lo,hi\n";
        for (std::uint32_t i = 0; i < robot.links().size(); ++i) {
            const std::uint32_t parent = robot.kinematics().parents()[i];
            text_ << fmt::format("link,{},{},{}\n", link(i), parent == i ? "" : link(parent),
                                 robot.links()[i].geometries.size());
        }
        for (const JointDescription& joint : robot.joints())
            text_ << fmt::format("joint,{},{},{}\n", joint.name, name_of(joint.kind),
                                 joint.kind == JointKind::fixed ||
                                         joint.kind == JointKind::continuous
                                     ? ","
                                     : fmt::format("{},{}", joint.lower, joint.upper));
        for (const AllowedPair& pair : robot_.allowed.pairs())
            text_ << fmt::format("allowed,{},{},{}\n", link(pair.a), link(pair.b),
                                 name_of(pair.reason));
    }
    void state(std::size_t i, std::span<const double> values, const SelfCollision& found) override {
        for (std::size_t k = 0; k < values.size(); ++k)
            text_ << fmt::format("value,{},{},{}\n", i, robot_.robot.value_name(k), values[k]);
        pairs("candidate", i, found.candidates);
        pairs("filtered", i, found.tested);
        pairs("colliding", i, found.colliding);
        if (found.nearest)
            text_ << fmt::format("least,{},{},{},{},{},{}\n", i, link(found.nearest->a),
                                 link(found.nearest->b), found.least.distance, found.least.lo,
                                 found.least.hi);
    }

  private:
    void pairs(std::string_view kind, std::size_t i, std::span<const Pair> pairs) {
        for (const Pair p : pairs)
            text_ << fmt::format("{},{},{},{}\n", kind, i, link(p.a), link(p.b));
    }
    bool header_;
};

class RobotJson final : public RobotPrinter {
  public:
    using RobotPrinter::RobotPrinter;

    void begin() override {
        const Robot& robot = robot_.robot;
        text_ << fmt::format("{{\"robot\":{},\"links\":[", json_string(robot.name()));
        for (std::uint32_t i = 0; i < robot.links().size(); ++i) {
            const std::uint32_t parent = robot.kinematics().parents()[i];
            text_ << fmt::format("{}{{\"name\":{},\"parent\":{},\"geometries\":{}}}", i ? "," : "",
                                 name(i), parent == i ? "null" : name(parent),
                                 robot.links()[i].geometries.size());
        }
        text_ << "],\"joints\":[";
        for (std::size_t j = 0; j < robot.joints().size(); ++j) {
            const JointDescription& joint = robot.joints()[j];
            const bool limited =
                joint.kind == JointKind::revolute || joint.kind == JointKind::prismatic;
            text_ << fmt::format(
                "{}{{\"name\":{},\"type\":\"{}\",\"parent\":{},\"child\":{},\"lower\":{},\"upper\":"
                "{},\"mimics\":{}}}",
                j ? "," : "", json_string(joint.name), name_of(joint.kind), name(joint.parent),
                name(joint.child), limited ? json_number(joint.lower) : "null",
                limited ? json_number(joint.upper) : "null",
                joint.mimic ? json_string(robot.joints()[joint.mimic->joint].name) : "null");
        }
        text_ << "],\"allowed_pairs\":[";
        const std::vector<AllowedPair> allowed = robot_.allowed.pairs();
        for (std::size_t k = 0; k < allowed.size(); ++k)
            text_ << fmt::format("{}{{\"links\":[{},{}],\"reason\":\"{}\",\"note\":{}}}",
                                 k ? "," : "", name(allowed[k].a), name(allowed[k].b),
                                 name_of(allowed[k].reason), json_string(allowed[k].note));
        text_ << "],\"states\":[";
    }
    void state(std::size_t i, std::span<const double> values, const SelfCollision& found) override {
        text_ << (i ? ",{" : "{") << "\"values\":{";
        for (std::size_t k = 0; k < values.size(); ++k)
            text_ << fmt::format("{}{}:{}", k ? "," : "", json_string(robot_.robot.value_name(k)),
                                 json_number(values[k]));
        text_ << "}";
        pairs("candidate_pairs", found.candidates);
        pairs("filtered_pairs", found.tested);
        pairs("colliding", found.colliding);
        text_ << fmt::format(
            ",\"distance\":{},\"lo\":{},\"hi\":{},\"nearest\":{}}}",
            json_number(found.least.distance), json_number(found.least.lo),
            json_number(found.least.hi),
            found.nearest ? fmt::format("[{},{}]", name(found.nearest->a), name(found.nearest->b))
                          : "null");
    }
    void end() override { text_ << "]}\n"; }

  private:
    std::string name(std::uint32_t i) const { return json_string(link(i)); }
    void pairs(std::string_view key, std::span<const Pair> pairs) {
        text_ << fmt::format(",\"{}\":[", key);
        for (std::size_t k = 0; k < pairs.size(); ++k)
            text_ << fmt::format("{}[{},{}]", k ? "," : "", name(pairs[k].a), name(pairs[k].b));
        text_ << "]";
    }
};

} // namespace

void run(const RobotQuery& query, const MakeLinkNarrowPhase& make_narrow_phase, std::ostream& out) {
    try {
        if (query.state && !query.srdf)
            throw BadInput("--state names a state of an SRDF file; give one by --srdf");
        const std::unique_ptr<RobotCase> robot = read_robot(query);
        const std::unique_ptr<LinkNarrowPhase> narrow_phase =
            make_narrow_phase(robot->robot, robot->meshes);
        propose_allowed(query, *narrow_phase, *robot);
        if (query.write_srdf)
            write_allowed(query, *robot);
        std::vector<double> values = chosen_state(query, *robot);
        RobotSelfCollision self(robot->robot, robot->boxes, robot->allowed, *narrow_phase);
        std::unique_ptr<RobotPrinter> printer;
        if (query.format.json)
            printer = std::make_unique<RobotJson>(*robot, out);
        else
            printer = std::make_unique<RobotLines>(*robot, query.format.header, out);
        printer->begin();
        for (std::uint64_t i = 0; i < query.random.value_or(1); ++i) {
            if (query.random)
                random_values(robot->robot.ranges(), query.seed, i, values);
            printer->state(i, values, self.check(values));
        }
        printer->end();
    } catch (const BadInput&) {
        throw;
    } catch (const std::runtime_error& error) { // of the files
        throw BadInput(error.what());
    } catch (const std::invalid_argument& error) { // of names
        throw BadInput(error.what());
    }
}

void add_query_robot(CLI::App& query, MakeLinkNarrowPhase narrow_phase) {
    auto options = std::make_shared<RobotQuery>();
    CLI::App* robot = query.add_subcommand(
        "robot", "self-collision of a robot: links, candidate pairs, pairs that collide, distance");
    robot->add_option("URDF", options->urdf, "the robot")->required();
    robot->add_option("--srdf", options->srdf, "an SRDF file: pairs that may collide, states");
    robot->add_option("--package-path", options->package_paths,
                      "a folder that holds the packages of package:// meshes; may be repeated");
    auto* joints = robot->add_option("--joints", options->joints,
                                     "\"NAME=VALUE,...\", radians or metres; the others at rest, "
                                     "which is 0, or as near to it as their limits allow");
    auto* state = robot->add_option("--state", options->state, "a state of the SRDF file");
    robot
        ->add_option("--random", options->random,
                     "so many states at random within the limits instead")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{10'000'000}))
        ->excludes(joints)
        ->excludes(state);
    robot->add_option("--seed", options->seed, "of --random and --samples")->capture_default_str();
    robot
        ->add_option("--samples", options->samples,
                     "allow pairs, too, that collide in all of so many random states, or in none")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}));
    robot->add_option("--write-srdf", options->write_srdf,
                      "write the allowed pairs, with what --srdf holds else, as an SRDF file");
    add_format_options(*robot, options->format);
    robot->footer(
        "Each line begins with what it is: link, joint, allowed, and for each state value,\n"
        "candidate (boxes of the links overlap), filtered (those that are not allowed), "
        "colliding,\n"
        "least (the least distance of links that are not allowed, 0 if two collide: the true one\n"
        "lies between lo and hi). Without --srdf adjacent links are allowed to collide.\n\n"
        "Examples:\n"
        "  boxwood query robot panda.urdf --srdf panda.srdf --joints \"panda_joint4=-2.3\"\n"
        "  boxwood query robot z1.urdf --samples 10000 --write-srdf z1.srdf --random 100 --seed 1");
    robot->callback([options, narrow_phase = std::move(narrow_phase)] {
        run(*options, narrow_phase, std::cout);
    });
}

} // namespace boxwood::bench
