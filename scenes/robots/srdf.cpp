#include "scenes/robots/srdf.h"

#include "scenes/robots/xml_reader.h"
#include "scenes/text/read_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace boxwood {
namespace {

namespace fs = std::filesystem;
using Element = tinyxml2::XMLElement;

constexpr std::array<AllowedReason, 6> all_reasons{
    AllowedReason::adjacent,      AllowedReason::never,   AllowedReason::always,
    AllowedReason::default_state, AllowedReason::sampled, AllowedReason::user};

char lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::optional<AllowedReason> reason_named(std::string_view word) {
    for (const AllowedReason reason : all_reasons)
        if (std::ranges::equal(word, name_of(reason), {}, lower_case))
            return reason;
    return std::nullopt;
}

/// "Never", or "Sampled: in none of 1000 samples", or something that somebody wrote.
std::pair<AllowedReason, std::string> parse_reason(std::string_view text) {
    const std::size_t colon = text.find(": ");
    if (const auto reason = reason_named(text.substr(0, colon)))
        return {*reason, std::string(colon == text.npos ? "" : text.substr(colon + 2))};
    return {AllowedReason::user, std::string(text)};
}

std::string reason_text(const AllowedPair& pair) {
    std::string text(name_of(pair.reason));
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
    return pair.note.empty() ? text : text + ": " + pair.note;
}

class SrdfParser {
  public:
    SrdfParser(const XmlReader& reader, const RobotDescription& robot) : reader_(reader) {
        for (const LinkDescription& link : robot.links)
            links_.emplace_back(link.name);
        for (const JointDescription& joint : robot.joints)
            joints_.emplace_back(joint.name);
    }

    Srdf parse() {
        const Element& robot = reader_.robot();
        for (const char* of_urdf : {"link", "joint"})
            if (const Element* e = robot.FirstChildElement(of_urdf))
                reader_.fail(*e, fmt::format("a <{}> of the robot: this is a URDF file; name the "
                                             "SRDF file, which has <disable_collisions>",
                                             of_urdf));
        for_each_child(robot, "disable_default_collisions", [&](const Element& e) {
            const std::uint32_t link = link_of(e, "link");
            for (std::uint32_t other = 0; other < links_.size(); ++other)
                if (other != link)
                    pairs_[std::minmax(link, other)] = {AllowedReason::user,
                                                        "disable_default_collisions"};
        });
        for_each_child(robot, "disable_collisions", [&](const Element& e) {
            std::string reason = e.Attribute("reason") ? e.Attribute("reason") : "User";
            std::ranges::replace_if(
                reason, [](char c) { return c >= 0 && c < ' '; }, ' '); // line ends are not kept
            pairs_[pair_of(e)] = parse_reason(reason);
        });
        for_each_child(robot, "enable_collisions",
                       [&](const Element& e) { pairs_.erase(pair_of(e)); });
        Srdf srdf;
        for (const auto& [pair, reason] : pairs_)
            srdf.allowed.push_back({pair.first, pair.second, reason.first, reason.second});
        add_states(srdf);
        return srdf;
    }

  private:
    using LinkPair = std::pair<std::uint32_t, std::uint32_t>;

    std::uint32_t link_of(const Element& e, const char* attribute) const {
        return static_cast<std::uint32_t>(reader_.index(e, attribute, "link of the robot", links_));
    }
    LinkPair pair_of(const Element& e) const {
        const std::uint32_t a = link_of(e, "link1"), b = link_of(e, "link2");
        if (a == b)
            reader_.fail(e, fmt::format("<{}>: link1 and link2 are both '{}'; name two links",
                                        e.Name(), links_[a]));
        return std::minmax(a, b);
    }
    void add_states(Srdf& srdf) const {
        const Element& robot = reader_.robot();
        std::vector<std::string> virtual_joints; // ties of the root to the world: not of the URDF
        for_each_child(robot, "virtual_joint", [&](const Element& e) {
            virtual_joints.push_back(reader_.text(e, "name"));
        });
        for_each_child(robot, "group_state", [&](const Element& e) {
            Srdf::State state{reader_.text(e, "name"), {}, {}};
            if (const char* group = e.Attribute("group"))
                state.group = group;
            for_each_child(e, "joint", [&](const Element& joint) {
                if (std::ranges::find(virtual_joints, reader_.text(joint, "name")) !=
                    virtual_joints.end())
                    return;
                const auto index = reader_.index(joint, "name", "joint of the robot", joints_);
                state.values.emplace_back(static_cast<std::uint32_t>(index),
                                          reader_.number(joint, "value"));
            });
            srdf.states.push_back(std::move(state));
        });
    }

    const XmlReader& reader_;
    std::vector<std::string_view> links_, joints_;
    std::map<LinkPair, std::pair<AllowedReason, std::string>> pairs_;
};

} // namespace

Srdf parse_srdf(std::string_view text, const std::string& source, const RobotDescription& robot) {
    const XmlReader reader(text, source, "SRDF");
    return SrdfParser(reader, robot).parse();
}

Srdf read_srdf(const fs::path& file, const RobotDescription& robot) {
    return parse_srdf(read_file(file, "SRDF"), file.string(), robot);
}

std::string srdf_text(const RobotDescription& robot, std::span<const AllowedPair> pairs,
                      std::string_view original) {
    tinyxml2::XMLDocument document;
    if (original.empty()) {
        document.InsertEndChild(document.NewDeclaration());
        document.InsertEndChild(document.NewElement("robot"));
        document.RootElement()->SetAttribute("name", robot.name.c_str());
    } else {
        parse_srdf(original, "SRDF", robot); // throws for what is wrong
        document.Parse(original.data(), original.size());
    }
    Element& root = *document.RootElement();
    for (const char* name :
         {"disable_default_collisions", "disable_collisions", "enable_collisions"})
        while (Element* old = root.FirstChildElement(name))
            root.DeleteChild(old);
    for (const AllowedPair& pair : pairs) {
        Element& e = *root.InsertNewChildElement("disable_collisions");
        e.SetAttribute("link1", robot.links.at(pair.a).name.c_str());
        e.SetAttribute("link2", robot.links.at(pair.b).name.c_str());
        e.SetAttribute("reason", reason_text(pair).c_str());
    }
    tinyxml2::XMLPrinter printer;
    document.Print(&printer);
    return printer.CStr();
}

} // namespace boxwood
