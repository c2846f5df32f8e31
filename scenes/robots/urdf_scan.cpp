/// First the names of links and joints are taken, then each joint's kind, ties, numbers and mimic,
/// and each link's shapes. What is found right is written again as plain URDF for liburdfdom.

#include "scenes/robots/urdf_scan.h"

#include "kernels/primitives/coordinate_limit.h"
#include "kernels/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

namespace boxwood {
namespace {

using Element = tinyxml2::XMLElement;

/// Digits that every reader takes; what is below 1e-290 is 0 to robots and an error to iostreams.
std::string plain_number(double x) { return fmt::format("{}", std::abs(x) < 1e-290 ? 0.0 : x); }
std::string plain_vector(Vec3<double> v) {
    return fmt::format("{} {} {}", plain_number(v.x), plain_number(v.y), plain_number(v.z));
}

class UrdfScanner {
  public:
    explicit UrdfScanner(const XmlReader& reader) : reader_(reader) {}

    UrdfScan scan() {
        const Element& robot = reader_.robot();
        scan_.name = robot.Attribute("name") ? robot.Attribute("name") : "";
        scan_.outline.name = scan_.name;
        links_ = named(robot, "link");
        joints_ = named(robot, "joint");
        if (links_.elements.empty())
            reader_.fail(robot, "the robot has no <link>; it needs one at least");
        scan_.plain = "<?xml version=\"1.0\"?>\n<robot name=\"robot\">\n";
        for (std::size_t i = 0; i < links_.elements.size(); ++i)
            add_link(i);
        for (std::size_t j = 0; j < joints_.elements.size(); ++j)
            add_joint(j);
        scan_.plain += "</robot>\n";
        return std::move(scan_);
    }

  private:
    struct Named {
        std::vector<const Element*> elements;
        std::vector<std::string_view> names;
        std::unordered_map<std::string_view, std::uint32_t> indices;
    };

    Named named(const Element& robot, const char* kind) const {
        Named all;
        for_each_child(robot, kind, [&](const Element& e) {
            reader_.text(e, "name");
            const std::string_view name = e.Attribute("name");
            const auto index = static_cast<std::uint32_t>(all.names.size());
            const auto [entry, is_new] = all.indices.try_emplace(name, index);
            if (!is_new)
                reader_.fail(e, fmt::format("a second <{} name=\"{}\">; the first is in line {}",
                                            kind, name, all.elements[entry->second]->GetLineNum()));
            all.elements.push_back(&e);
            all.names.push_back(name);
        });
        return all;
    }

    /// The index of the name in an attribute.
    std::uint32_t find(const Named& all, const Element& of, const char* attribute,
                       std::string_view what) const {
        const auto found = all.indices.find(reader_.text(of, attribute));
        return found != all.indices.end()
                   ? found->second
                   : static_cast<std::uint32_t>(reader_.index(of, attribute, what, all.names));
    }

    void require_range(const Element& of, const char* attribute, double number) const {
        if (!(std::abs(number) < coordinate_limit))
            reader_.fail(
                of, fmt::format("<{} {}=...>: {} is beyond 2^60", of.Name(), attribute, number));
    }

    Vec3<double> lengths(const Element& of, const char* attribute,
                         std::optional<Vec3<double>> fallback = {}) const {
        const Vec3<double> v =
            fallback ? reader_.vector(of, attribute, *fallback) : reader_.vector(of, attribute);
        for (const double number : {v.x, v.y, v.z})
            require_range(of, attribute, number);
        return v;
    }

    double size(const Element& of, const char* attribute) const {
        const double number = reader_.number(of, attribute);
        if (number < 0)
            reader_.fail(of, fmt::format("<{} {}=\"{}\">: it must not be negative", of.Name(),
                                         attribute, number));
        require_range(of, attribute, number);
        return number;
    }

    std::string plain_origin(const Element& of) const {
        const Element* origin = of.FirstChildElement("origin");
        if (!origin)
            return {};
        return fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>",
                           plain_vector(lengths(*origin, "xyz", Vec3<double>{})),
                           plain_vector(reader_.vector(*origin, "rpy", {})));
    }

    LinkMesh mesh(const Element& shape, std::size_t link) {
        const Vec3<double> scale = lengths(shape, "scale", Vec3<double>{1, 1, 1});
        if (scale.x == 0 || scale.y == 0 || scale.z == 0)
            reader_.fail(shape, "<mesh scale=...>: 0 makes the mesh flat; 1 1 1 keeps its size");
        scan_.meshes.push_back(
            {&shape, reader_.text(shape, "filename"), std::string(links_.names[link])});
        return {static_cast<std::uint32_t>(scan_.meshes.size() - 1), scale};
    }

    /// The shape, and its element for liburdfdom.
    std::pair<LinkShape, std::string> shape(const Element& e, std::size_t link) {
        const std::string_view kind = e.Name();
        if (kind == "mesh")
            return {mesh(e, link), "<sphere radius=\"0\"/>"};
        if (kind == "box") {
            const Vec3<double> sides = lengths(e, "size");
            if (std::min({sides.x, sides.y, sides.z}) < 0)
                reader_.fail(e, "<box size=...>: a side must not be negative");
            return {LinkBox{}, fmt::format("<box size=\"{}\"/>", plain_vector(sides))};
        }
        if (kind == "sphere")
            return {LinkSphere{},
                    fmt::format("<sphere radius=\"{}\"/>", plain_number(size(e, "radius")))};
        const double radius = kind == "cylinder" || kind == "capsule" ? size(e, "radius") : 0;
        const double length = kind == "cylinder" || kind == "capsule" ? size(e, "length") : 0;
        if (kind == "cylinder")
            return {LinkCylinder{}, fmt::format("<cylinder radius=\"{}\" length=\"{}\"/>",
                                                plain_number(radius), plain_number(length))};
        if (kind == "capsule")
            return {LinkCapsule{radius, length}, "<sphere radius=\"0\"/>"};
        constexpr std::array<std::string_view, 5> kinds{"mesh", "box", "sphere", "cylinder",
                                                        "capsule"};
        reader_.fail(e, unknown_name("geometry", kind, kinds));
    }

    void add_link(std::size_t i) {
        LinkDescription link{std::string(links_.names[i])};
        scan_.plain += fmt::format("<link name=\"L{}\">", i);
        for_each_child(*links_.elements[i], "collision", [&](const Element& collision) {
            const Element& geometry = reader_.child(collision, "geometry");
            const Element* first = geometry.FirstChildElement();
            if (!first || first->NextSiblingElement())
                reader_.fail(geometry, fmt::format("link '{}': <geometry> needs one shape in it: "
                                                   "mesh, box, sphere, cylinder or capsule",
                                                   link.name));
            auto [found, plain] = shape(*first, i);
            link.geometries.push_back({found, {}});
            scan_.plain += fmt::format("<collision>{}<geometry>{}</geometry></collision>",
                                       plain_origin(collision), plain);
        });
        scan_.plain += "</link>\n";
        scan_.outline.links.push_back(std::move(link));
    }

    JointKind kind(const Element& e) const {
        const std::string type = reader_.text(e, "type");
        for (const JointKind kind :
             {JointKind::fixed, JointKind::revolute, JointKind::continuous, JointKind::prismatic})
            if (type == name_of(kind))
                return kind;
        if (type == "planar" || type == "floating")
            reader_.fail(e, fmt::format("joint '{}' is {}, which is not supported: it has {} "
                                        "values; split it into prismatic and revolute joints, or "
                                        "make it fixed",
                                        e.Attribute("name"), type, type == "planar" ? 3 : 6));
        constexpr std::array<std::string_view, 4> kinds{"fixed", "revolute", "continuous",
                                                        "prismatic"};
        reader_.fail(e, fmt::format("joint '{}': {}", e.Attribute("name"),
                                    unknown_name("type of joint", type, kinds)));
    }

    std::string plain_limits(const Element& e, JointDescription& joint) const {
        const Element* limit = e.FirstChildElement("limit");
        if (!limit)
            reader_.fail(
                e, fmt::format("joint '{0}' is {1} and has no limits; give it <limit "
                               "lower=\"...\" upper=\"...\"/>{2}",
                               joint.name, name_of(joint.kind),
                               joint.kind == JointKind::revolute ? ", or make it continuous" : ""));
        joint.lower = reader_.number(*limit, "lower", 0); // 0 as the format has it
        joint.upper = reader_.number(*limit, "upper", 0);
        if (joint.lower > joint.upper)
            reader_.fail(*limit, fmt::format("joint '{}': its lower limit {} is above the upper "
                                             "one, {}",
                                             joint.name, joint.lower, joint.upper));
        return fmt::format("<limit effort=\"0\" velocity=\"0\" lower=\"{}\" upper=\"{}\"/>",
                           plain_number(joint.lower), plain_number(joint.upper));
    }

    void add_joint(std::size_t j) {
        const Element& e = *joints_.elements[j];
        JointDescription joint{std::string(joints_.names[j])};
        joint.kind = kind(e);
        joint.parent = find(links_, reader_.child(e, "parent"), "link", "link");
        joint.child = find(links_, reader_.child(e, "child"), "link", "link");
        std::string plain = plain_origin(e);
        if (joint.kind != JointKind::fixed) {
            const Element* axis = e.FirstChildElement("axis");
            joint.axis = axis ? reader_.vector(*axis, "xyz") : Vec3<double>{1, 0, 0};
            if (joint.axis == Vec3<double>{})
                reader_.fail(*axis, fmt::format("joint '{}': an axis of 0 0 0 has no direction",
                                                joint.name));
            plain += fmt::format("<axis xyz=\"{}\"/>", plain_vector(joint.axis));
            if (joint.kind != JointKind::continuous)
                plain += plain_limits(e, joint);
            if (const Element* mimic = e.FirstChildElement("mimic")) {
                joint.mimic = Mimic{find(joints_, *mimic, "joint", "joint"),
                                    reader_.number(*mimic, "multiplier", 1),
                                    reader_.number(*mimic, "offset", 0)};
                plain += fmt::format("<mimic joint=\"J{}\" multiplier=\"{}\" offset=\"{}\"/>",
                                     joint.mimic->joint, plain_number(joint.mimic->multiplier),
                                     plain_number(joint.mimic->offset));
            }
        }
        scan_.plain += fmt::format("<joint name=\"J{}\" type=\"{}\"><parent link=\"L{}\"/><child "
                                   "link=\"L{}\"/>{}</joint>\n",
                                   j, name_of(joint.kind), joint.parent, joint.child, plain);
        scan_.outline.joints.push_back(std::move(joint));
    }

    const XmlReader& reader_;
    UrdfScan scan_;
    Named links_, joints_;
};

} // namespace

UrdfScan scan_urdf(const XmlReader& reader) { return UrdfScanner(reader).scan(); }

} // namespace boxwood
