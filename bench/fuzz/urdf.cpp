/// URDF files: refused with the file's name, or a robot whose links have poses.

#include "scenes/robots/urdf.h"
#include "bench/fuzz/fuzz.h"
#include "kernels/kinematics/kinematic_tree.h"

namespace boxwood::fuzz {

void urdf(Bytes bytes) {
    const std::filesystem::path nowhere[]{"/nonexistent"};
    UrdfRobot robot;
    try {
        robot = parse_urdf(text_of(bytes), "fuzz.urdf", nowhere, false);
    } catch (const std::runtime_error& error) {
        require(std::string_view(error.what()).starts_with("fuzz.urdf:"),
                std::string("an error without the file's name: ") + error.what());
        return;
    }
    const KinematicTree tree(robot.description);
    require(tree.n_links() == robot.description.links.size(), "links are missing");
    std::vector<double> values;
    for (const ValueRange& range : tree.ranges()) {
        require(range.lower <= range.upper, "a range without a value");
        values.push_back(range.lower);
    }
    std::vector<RigidTransform<double>> poses(tree.n_links());
    tree.forward(values, poses);
}

} // namespace boxwood::fuzz
