#pragma once

#include "kernels/boxes/fit.h"
#include "kernels/kinematics/kinematic_tree.h"
#include "kernels/primitives/aabb.h"
#include "kernels/primitives/triangle.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood {

/// A robot: links, joints between them, and where the links are for given values of the joints.
/// It has one value per joint that moves and mimics none, in the order of the joints: radians or
/// metres. Immutable; any number of threads may read it at once.
class Robot {
  public:
    /// Throws std::invalid_argument, which names the link or joint, for what KinematicTree refuses.
    /// Origins of geometries are made orthonormal to a few roundings.
    explicit Robot(RobotDescription description);

    const std::string& name() const { return description_.name; }
    std::span<const LinkDescription> links() const { return description_.links; }
    std::span<const JointDescription> joints() const { return description_.joints; }
    const RobotDescription& description() const { return description_; }
    const KinematicTree& kinematics() const { return tree_; }

    std::size_t n_values() const { return tree_.n_values(); }
    std::span<const ValueRange> ranges() const { return tree_.ranges(); }
    const std::string& value_name(std::size_t value) const; ///< of its joint

    /// By name. Throw std::invalid_argument, with a suggestion, if there is none; `value` also for
    /// a joint that has no value of its own.
    std::uint32_t link(std::string_view name) const;
    std::size_t value(std::string_view joint) const;

    /// Where each value is 0, or as near to 0 as its range allows.
    std::vector<double> rest() const;

    /// Forward kinematics: the pose of each link, the root's being `root`, as checked_pose gives
    /// one. Values beyond their ranges are taken as they are. Throws std::invalid_argument unless
    /// there are n_values() finite values, room for exactly links().size() poses, and each link is
    /// turned by a finite angle and lies below 2^60. Allocates nothing.
    void poses(std::span<const double> values, std::span<RigidTransform<double>> poses,
               const RigidTransform<double>& root = {}) const;

    /// The values at part t of the way from one state to another, 0 <= t <= 1: in proportion, and
    /// for continuous joints the shorter way round (then at t = 1 they may differ from `to` by
    /// whole turns). Spans of n_values() each; `out` may be one of the others. Only + - * / and
    /// remainders: the same bits on every machine.
    void interpolate(std::span<const double> from, std::span<const double> to, double t,
                     std::span<double> out) const;

  private:
    RobotDescription description_;
    KinematicTree tree_;
};

/// States of a robot, to be passed through one after another, each after the same time.
class JointPath {
  public:
    /// The robot must outlive the path. Throws std::invalid_argument unless there is a state, and
    /// each has a finite value per joint that has one.
    JointPath(const Robot& robot, std::vector<std::vector<double>> states);

    std::size_t size() const { return states_.size(); }
    std::span<const double> state(std::size_t i) const { return states_[i]; }
    /// Values at time s: state i at s = i, interpolated between; the ends beyond 0 and size() - 1.
    void at(double s, std::span<double> out) const;

  private:
    const Robot* robot_;
    std::vector<std::vector<double>> states_;
};

/// The mesh that a LinkMesh means: its vertices scaled and rounded to floats, axis by axis. Of a
/// mirrored one two corners of each triangle change places, so that outside stays outside.
TriangleMesh scaled(TriangleMesh mesh, Vec3<double> scale);

/// Boxes around the links of a robot, for candidate pairs.
class LinkBoxes {
  public:
    /// mesh_boxes: of the meshes that the links name, in their own frames. Throws
    /// std::invalid_argument, naming the link, for a mesh that is not there or whose box is empty.
    LinkBoxes(const Robot& robot, std::span<const Aabb<float>> mesh_boxes);

    /// The links with geometry, ascending; the others have no box.
    std::span<const std::uint32_t> links() const { return links_; }
    /// boxes[i], of every link i: contains its geometry, of meshes as `scaled` gives them, too,
    /// under the exact matrices of its origin, then of poses[i]; empty without geometry. Spans of
    /// one element per link. Allocates nothing.
    void boxes(std::span<const RigidTransform<double>> poses, std::span<Aabb<double>> boxes) const;

  private:
    std::vector<std::uint32_t> links_;
    std::vector<std::size_t> first_;        ///< of each link in parts_; one more at the end
    std::vector<CentredBox<double>> parts_; ///< around each shape, in its link's frame
};

} // namespace boxwood
