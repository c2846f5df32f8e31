#pragma once

#include "kernels/kinematics/robot_description.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace boxwood {

/// Where a value may lie: between the limits of its joint, or -pi and pi if it goes round.
struct ValueRange {
    double lower, upper;
    bool wraps; ///< of a continuous joint: values 2 pi apart are the same
};

/// The joints of a robot in the order in which poses follow from each other: what finds the poses
/// of its links. A robot has one value per joint that moves and mimics none, in the order of the
/// joints.
class KinematicTree {
  public:
    /// Throws std::invalid_argument naming the link or joint: names that are empty or used twice,
    /// links that no joint ties to the others, cycles, two parents; numbers that are not finite,
    /// negative sizes, axes of length 0, limits the wrong way round, rotations that are none;
    /// joints that mimic themselves or a fixed one.
    explicit KinematicTree(const RobotDescription& robot);

    std::size_t n_links() const { return n_links_; }
    std::size_t n_values() const { return ranges_.size(); }
    std::uint32_t root() const { return root_; }
    std::span<const ValueRange> ranges() const { return ranges_; }
    /// The joint of each value.
    std::span<const std::uint32_t> joints_of_values() const { return joints_of_values_; }
    /// Of each link, the link that it hangs on; its own number for the root.
    std::span<const std::uint32_t> parents() const { return parents_; }
    /// Of each link, the root of the part that fixed joints make one with it.
    std::span<const std::uint32_t> rigid_parts() const { return rigid_parts_; }

    /// Forward kinematics: the pose of every link in the frame that the root's pose is given in.
    /// values: n_values() finite ones, within their ranges or not; poses: n_links(); root: a
    /// rotation up to rounding, no reflection.
    /// Each rotation is orthonormal to 16 roundings, however long the chain. Allocates nothing.
    void forward(std::span<const double> values, std::span<RigidTransform<double>> poses,
                 const RigidTransform<double>& root = {}) const;

  private:
    /// The child's frame in the parent's, at value q of the joint: turned by
    /// rotation + sin q * sine + cos q * cosine if it turns, at translation + q * slide.
    struct Step {
        std::uint32_t parent, child;
        std::uint32_t value = 0; ///< not of fixed joints
        bool turns = false, slides = false;
        bool parallel = false;             ///< axes of both frames are parallel at any value
        double multiplier = 1, offset = 0; ///< q = multiplier * value + offset
        std::array<Vec3<double>, 3> rotation{}, sine{}, cosine{};
        Vec3<double> translation{}, slide{};
    };
    static Step step_of(const JointDescription& joint);

    std::size_t n_links_;
    std::uint32_t root_ = 0;
    std::vector<Step> steps_;
    std::vector<ValueRange> ranges_;
    std::vector<std::uint32_t> joints_of_values_, parents_, rigid_parts_;
};

} // namespace boxwood
