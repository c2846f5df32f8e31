#pragma once

#include "trees/queries/sinks.h"
#include "trees/world/allowed_pairs.h"
#include "trees/world/robot.h"

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace boxwood {

/// The true distance lies between lo and hi; hi infinite: it is at least lo, and lo the limit or
/// more.
struct LinkDistance {
    double distance = std::numeric_limits<double>::infinity();
    double lo = std::numeric_limits<double>::infinity();
    double hi = std::numeric_limits<double>::infinity();
};

/// Answers questions about the geometries of two links of one robot. poses: of all its links.
class LinkNarrowPhase {
  public:
    virtual ~LinkNarrowPhase() = default;
    /// Whether they share a point.
    virtual bool collide(std::uint32_t a, std::uint32_t b,
                         std::span<const RigidTransform<double>> poses) const = 0;
    /// How far apart they are, if that is less than `limit`.
    virtual LinkDistance distance(std::uint32_t a, std::uint32_t b,
                                  std::span<const RigidTransform<double>> poses,
                                  double limit) const = 0;
};

/// What is known of a robot in one state; pairs of links, sorted.
struct SelfCollision {
    std::vector<Pair> candidates; ///< whose boxes overlap
    std::vector<Pair> tested;     ///< those whose collision is not allowed
    std::vector<Pair> colliding;  ///< those of them that share a point
    /// Of all pairs with geometry that are not allowed, the two links that are nearest to each
    /// other, and how near: lo <= the least distance of all <= hi. None if there is no such pair.
    std::optional<Pair> nearest;
    LinkDistance least{};
};

/// Self-collision of a robot: boxes of the links, then the allowed pairs, then a narrow phase.
/// All four arguments must outlive it and stay as they are. One state at a time; each thread needs
/// its own.
class RobotSelfCollision {
  public:
    /// Throws std::invalid_argument unless `allowed` has one item per link.
    RobotSelfCollision(const Robot& robot, const LinkBoxes& boxes, const AllowedPairs& allowed,
                       const LinkNarrowPhase& narrow_phase);

    /// Whether a pair that is not allowed shares a point; stops at the first. The values are those
    /// of Robot::poses, which says what is refused. Allocates nothing but what the narrow phase
    /// does.
    bool collides(std::span<const double> values);

    /// Everything. The answer stays until the next call.
    const SelfCollision& check(std::span<const double> values);

    /// Of the last state.
    std::span<const RigidTransform<double>> poses() const { return poses_; }
    std::span<const Aabb<double>> boxes() const { return boxes_; }

  private:
    struct Near {
        double gap; ///< at most the distance
        Pair pair;
    };
    void place(std::span<const double> values);
    void find_least();

    const Robot* robot_;
    const LinkBoxes* link_boxes_;
    const LinkNarrowPhase* narrow_phase_;
    std::vector<Pair> pairs_, pairs_to_test_; ///< all with geometry; those that are not allowed
    std::size_t touched_last_ = 0;            ///< in pairs_to_test_: tested first in `collides`
    std::vector<RigidTransform<double>> poses_;
    std::vector<Aabb<double>> boxes_;
    std::vector<Near> by_gap_;
    SelfCollision answer_;
};

} // namespace boxwood
