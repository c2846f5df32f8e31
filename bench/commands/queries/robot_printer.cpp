#include "bench/commands/queries/robot_printer.h"

#include "bench/io/json.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace boxwood::bench {
namespace {

class NamingPrinter : public RobotPrinter {
  public:
    NamingPrinter(const RobotCase& robot, std::ostream& out) : robot_(robot), text_(out) {}

  protected:
    const std::string& link(std::uint32_t i) const { return robot_.robot.links()[i].name; }

    const RobotCase& robot_;
    BlockWriter text_;
};

/// One line per item, which begins with what it is.
class RobotLines final : public NamingPrinter {
  public:
    RobotLines(const RobotCase& robot, bool header, std::ostream& out)
        : NamingPrinter(robot, out), header_(header) {}

    void begin() override {
        const Robot& robot = robot_.robot;
        if (header_)
            text_ << "link,name,parent,geometries\njoint,name,type,lower,upper\n"
                     "allowed,link,link,reason\nvalue,state,joint,value\n"
                     "candidate,state,link,link\nfiltered,state,link,link\n"
                     "colliding,state,link,link\nleast,state,link,link,distance,lo,hi\n"
                     "hit,state,link,obstacle\nclearance,state,link,obstacle,distance,lo,hi\n";
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
    void state(std::size_t i, std::span<const double> values, const SelfCollision& found,
               const Surroundings::Answer* around) override {
        for (std::size_t k = 0; k < values.size(); ++k)
            text_ << fmt::format("value,{},{},{}\n", i, robot_.robot.value_name(k), values[k]);
        pairs("candidate", i, found.candidates);
        pairs("filtered", i, found.tested);
        pairs("colliding", i, found.colliding);
        if (found.nearest)
            text_ << fmt::format("least,{},{},{},{},{},{}\n", i, link(found.nearest->a),
                                 link(found.nearest->b), found.least.distance, found.least.lo,
                                 found.least.hi);
        if (!around)
            return;
        for (const auto& [link_number, obstacle] : around->hits)
            text_ << fmt::format("hit,{},{},{}\n", i, link(link_number), obstacle);
        if (around->nearest) {
            const auto& [between, d] = *around->nearest;
            text_ << fmt::format("clearance,{},{},{},{},{},{}\n", i, link(between.link),
                                 between.obstacle, d.distance, d.lo, d.hi);
        }
    }
    void end(const QueryTimes& times) override {
        text_.flush();
        times.report();
    }

  private:
    void pairs(std::string_view kind, std::size_t i, std::span<const Pair> pairs) {
        for (const Pair p : pairs)
            text_ << fmt::format("{},{},{},{}\n", kind, i, link(p.a), link(p.b));
    }
    bool header_;
};

class RobotJson final : public NamingPrinter {
  public:
    using NamingPrinter::NamingPrinter;

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
    void state(std::size_t i, std::span<const double> values, const SelfCollision& found,
               const Surroundings::Answer* around) override {
        text_ << (i ? ",{" : "{") << "\"values\":{";
        for (std::size_t k = 0; k < values.size(); ++k)
            text_ << fmt::format("{}{}:{}", k ? "," : "", json_string(robot_.robot.value_name(k)),
                                 json_number(values[k]));
        text_ << "}";
        pairs("candidate_pairs", found.candidates);
        pairs("filtered_pairs", found.tested);
        pairs("colliding", found.colliding);
        text_ << fmt::format(
            ",\"distance\":{},\"lo\":{},\"hi\":{},\"nearest\":{}",
            json_number(found.least.distance), json_number(found.least.lo),
            json_number(found.least.hi),
            found.nearest ? fmt::format("[{},{}]", name(found.nearest->a), name(found.nearest->b))
                          : "null");
        if (around)
            obstacles(*around);
        text_ << "}";
    }
    void end(const QueryTimes& times) override { text_ << fmt::format("]{}}}\n", times.json()); }

  private:
    std::string name(std::uint32_t i) const { return json_string(link(i)); }
    std::string json_of(const Surroundings::Meeting& m) const {
        return fmt::format("[{},{}]", name(m.link), json_string(m.obstacle));
    }
    void obstacles(const Surroundings::Answer& around) {
        text_ << ",\"obstacles\":{\"hits\":[";
        bool is_first = true;
        for (const Surroundings::Meeting& m : around.hits) {
            text_ << (is_first ? "" : ",") << json_of(m);
            is_first = false;
        }
        const auto& nearest = around.nearest;
        const BodyDistance d = nearest ? nearest->second : BodyDistance();
        text_ << fmt::format("],\"distance\":{},\"lo\":{},\"hi\":{},\"nearest\":{}}}",
                             json_number(d.distance), json_number(d.lo), json_number(d.hi),
                             nearest ? json_of(nearest->first) : "null");
    }
    void pairs(std::string_view key, std::span<const Pair> pairs) {
        text_ << fmt::format(",\"{}\":[", key);
        for (std::size_t k = 0; k < pairs.size(); ++k)
            text_ << fmt::format("{}[{},{}]", k ? "," : "", name(pairs[k].a), name(pairs[k].b));
        text_ << "]";
    }
};

} // namespace

std::unique_ptr<RobotPrinter> make_robot_printer(const RobotCase& robot, const Format& format,
                                                 std::ostream& out) {
    if (format.json)
        return std::make_unique<RobotJson>(robot, out);
    return std::make_unique<RobotLines>(robot, format.header, out);
}

} // namespace boxwood::bench
