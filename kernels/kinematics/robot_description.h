#pragma once

#include "kernels/primitives/rigid_transform.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// A robot as plain data: what a URDF file says of links, joints and collision geometry, whoever
/// read it. Metres and radians. `KinematicTree` checks it and finds the poses of the links.
namespace boxwood {

/// Shapes of links, in a frame of their own. No size is negative; sets are closed.
struct LinkMesh {
    std::uint32_t mesh = 0;      ///< index into the robot's meshes
    Vec3<double> scale{1, 1, 1}; ///< per axis; a negative one mirrors
    bool operator==(const LinkMesh&) const = default;
};
struct LinkBox {
    Vec3<double> sides; ///< in full; centred
    bool operator==(const LinkBox&) const = default;
};
struct LinkSphere {
    double radius; ///< centred
    bool operator==(const LinkSphere&) const = default;
};
struct LinkCylinder {
    double radius, length; ///< along z, centred
    bool operator==(const LinkCylinder&) const = default;
};
struct LinkCapsule {
    double radius, length; ///< along z, centred; length: of the segment, without the round ends
    bool operator==(const LinkCapsule&) const = default;
};
using LinkShape = std::variant<LinkMesh, LinkBox, LinkSphere, LinkCylinder, LinkCapsule>;

struct LinkGeometry {
    LinkShape shape;
    RigidTransform<double> origin{}; ///< of the shape's frame, in the link's
};

struct LinkDescription {
    std::string name;
    std::vector<LinkGeometry> geometries{}; ///< for collision; none: it never collides
};

enum class JointKind : std::uint8_t {
    fixed,
    revolute,   ///< turns about the axis, between limits
    continuous, ///< turns about the axis, without limits
    prismatic,  ///< slides along the axis, between limits
};
std::string_view name_of(JointKind kind);

/// The value of a joint that follows another one: multiplier * that value + offset.
struct Mimic {
    std::uint32_t joint = 0; ///< the one followed
    double multiplier = 1, offset = 0;
};

struct JointDescription {
    std::string name;
    JointKind kind = JointKind::fixed;
    std::uint32_t parent = 0, child = 0; ///< links
    RigidTransform<double> origin{};     ///< of the child's frame at value 0, in the parent's
    Vec3<double> axis{1, 0, 0};          ///< of movable joints, in the child's frame; any length
    double lower = 0, upper = 0;         ///< of revolute and prismatic joints
    std::optional<Mimic> mimic{};
};

struct RobotDescription {
    std::string name;
    std::vector<LinkDescription> links{};
    std::vector<JointDescription> joints{};
};

/// Why a pair of links may collide without being reported.
enum class AllowedReason : std::uint8_t {
    adjacent,      ///< they share a joint
    never,         ///< they cannot meet
    always,        ///< they meet in every state
    default_state, ///< they meet in the default state
    sampled,       ///< not seen to meet in a number of samples, which proves nothing
    user,          ///< somebody says so
};
std::string_view name_of(AllowedReason reason);

/// A pair of items, a < b, whose collision is allowed, and what a file or person says of it beyond
/// the reason.
struct AllowedPair {
    std::uint32_t a = 0, b = 0;
    AllowedReason reason = AllowedReason::user;
    std::string note{};
    bool operator==(const AllowedPair&) const = default;
};

} // namespace boxwood
