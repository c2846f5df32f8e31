/// scan_urdf looks at the text and makes it plain; KinematicTree checks that links and joints make
/// a tree; liburdfdom reads the plain text; its numbers go into the outline of the scan. Then the
/// meshes are found and read.

#include "scenes/robots/urdf.h"

#include "kernels/kinematics/kinematic_tree.h"
#include "scenes/meshes/mesh_file.h"
#include "scenes/robots/mesh_path.h"
#include "scenes/robots/urdf_scan.h"
#include "scenes/text/read_file.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <map>
#include <mutex>

namespace boxwood {
namespace {

namespace fs = std::filesystem;

/// Keeps what liburdfdom would print of errors. It may go on after one, with a part left out.
class UrdfdomLog final : public console_bridge::OutputHandler {
  public:
    UrdfdomLog() : before_(console_bridge::getOutputHandler()) {
        console_bridge::useOutputHandler(this);
    }
    ~UrdfdomLog() override { console_bridge::useOutputHandler(before_); }
    UrdfdomLog(const UrdfdomLog&) = delete;
    UrdfdomLog& operator=(const UrdfdomLog&) = delete;
    void log(const std::string& line, console_bridge::LogLevel level, const char*, int) override {
        if (level >= console_bridge::CONSOLE_BRIDGE_LOG_WARN)
            text += text.empty() ? line : "; " + line;
    }
    std::string text;

  private:
    console_bridge::OutputHandler* before_;
};

/// A model whose links do not hold each other: freeing a chain of them would recurse.
class UrdfdomModel {
  public:
    UrdfdomModel(const std::string& plain, const std::string& source) {
        static std::mutex one_at_a_time; // the log is the program's
        const std::lock_guard lock(one_at_a_time);
        UrdfdomLog log;
        model_ = urdf::parseURDF(plain);
        if (!model_ || !log.text.empty())
            throw std::runtime_error(
                fmt::format("{}: liburdfdom does not take it: {}", source, log.text));
    }
    ~UrdfdomModel() {
        for (auto& [name, link] : model_->links_) {
            link->child_links.clear();
            link->child_joints.clear();
        }
    }
    UrdfdomModel(const UrdfdomModel&) = delete;
    UrdfdomModel& operator=(const UrdfdomModel&) = delete;

    const urdf::Link& link(std::size_t i) const {
        return *model_->links_.at(fmt::format("L{}", i));
    }
    const urdf::Joint& joint(std::size_t j) const {
        return *model_->joints_.at(fmt::format("J{}", j));
    }

  private:
    urdf::ModelInterfaceSharedPtr model_;
};

Vec3<double> vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

RigidTransform<double> transform_of(const urdf::Pose& pose) {
    const double x = pose.rotation.x, y = pose.rotation.y, z = pose.rotation.z, w = pose.rotation.w;
    return {{{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
              {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
              {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}},
            vector_of(pose.position)};
}

/// Sizes as liburdfdom has read them; meshes and capsules, which the scan has, stay.
struct TakeSizes {
    const urdf::Geometry& from;

    void operator()(LinkMesh&) const {}
    void operator()(LinkCapsule&) const {}
    void operator()(LinkBox& box) const {
        box.sides = vector_of(dynamic_cast<const urdf::Box&>(from).dim);
    }
    void operator()(LinkSphere& sphere) const {
        sphere.radius = dynamic_cast<const urdf::Sphere&>(from).radius;
    }
    void operator()(LinkCylinder& cylinder) const {
        const auto& read = dynamic_cast<const urdf::Cylinder&>(from);
        cylinder.radius = read.radius;
        cylinder.length = read.length;
    }
};

void take_numbers(const UrdfdomModel& model, RobotDescription& robot) {
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        auto& geometries = robot.links[i].geometries;
        const auto& read = model.link(i).collision_array;
        if (read.size() != geometries.size())
            throw std::logic_error("liburdfdom reads another number of collision elements");
        for (std::size_t k = 0; k < geometries.size(); ++k) {
            geometries[k].origin = transform_of(read[k]->origin);
            std::visit(TakeSizes{*read[k]->geometry}, geometries[k].shape);
        }
    }
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
        JointDescription& joint = robot.joints[j];
        const urdf::Joint& read = model.joint(j);
        joint.origin = transform_of(read.parent_to_joint_origin_transform);
        if (joint.kind != JointKind::fixed)
            joint.axis = vector_of(read.axis);
        if (read.limits && joint.kind != JointKind::continuous) {
            joint.lower = read.limits->lower;
            joint.upper = read.limits->upper;
        }
        if (joint.mimic) {
            joint.mimic->multiplier = read.mimic->multiplier;
            joint.mimic->offset = read.mimic->offset;
        }
    }
}

void check_tree(const RobotDescription& robot, const std::string& source) {
    try {
        const KinematicTree tree(robot);
    } catch (const std::invalid_argument& error) {
        throw std::runtime_error(fmt::format("{}: {}", source, error.what()));
    }
}

/// Finds and reads each mesh once; the n-th LinkMesh then names its index.
void add_meshes(const XmlReader& reader, const UrdfScan& scan, const fs::path& urdf_file,
                std::span<const fs::path> package_folders, bool load_meshes, const LoadMesh& load,
                UrdfRobot& robot) {
    std::map<fs::path, std::uint32_t> known;
    std::vector<std::uint32_t> index_of;
    for (const UrdfScan::Mesh& mesh : scan.meshes) {
        try {
            const fs::path file = mesh_path(mesh.file_name, urdf_file, package_folders);
            const auto next = static_cast<std::uint32_t>(robot.mesh_files.size());
            const auto [entry, is_new] = known.try_emplace(file, next);
            index_of.push_back(entry->second);
            if (!is_new)
                continue;
            robot.mesh_files.push_back(file);
            if (load_meshes)
                robot.meshes.push_back(load ? load(file) : load_mesh(file));
        } catch (const std::runtime_error& error) {
            reader.fail(*mesh.element, fmt::format("link '{}': {}", mesh.link, error.what()));
        }
    }
    for (LinkDescription& link : robot.description.links)
        for (LinkGeometry& geometry : link.geometries)
            if (auto* mesh = std::get_if<LinkMesh>(&geometry.shape))
                mesh->mesh = index_of[mesh->mesh];
}

} // namespace

UrdfRobot parse_urdf(std::string_view text, const fs::path& file,
                     std::span<const fs::path> package_folders, bool load_meshes,
                     const LoadMesh& load) {
    const XmlReader reader(text, file.string(), "URDF");
    UrdfScan scan = scan_urdf(reader);
    UrdfRobot robot;
    robot.description = std::move(scan.outline);
    check_tree(robot.description, reader.source());
    take_numbers(UrdfdomModel(scan.plain, reader.source()), robot.description);
    check_tree(robot.description, reader.source());
    add_meshes(reader, scan, file, package_folders, load_meshes, load, robot);
    return robot;
}

UrdfRobot read_urdf(const fs::path& file, std::span<const fs::path> package_folders,
                    const LoadMesh& load) {
    return parse_urdf(read_file(file, "URDF"), file, package_folders, true, load);
}

} // namespace boxwood
