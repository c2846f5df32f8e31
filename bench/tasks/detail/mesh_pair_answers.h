#pragma once

#include "kernels/primitives/vec3.h"
#include "trees/queries/sinks.h"

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

/// What tasks about a mesh and a copy of it are answered with.
namespace boxwood::bench {

/// Two triangles that touch in one of the scene's poses.
struct PosedPair {
    std::uint32_t pose, a, b;
    constexpr auto operator<=>(const PosedPair&) const = default;
};

/// Of one pose: how far apart the two are, in doubles, by which triangles, and where on them, in
/// the mesh's frame, if that is said.
struct PosedDistance {
    struct Points {
        Vec3<double> on_mesh, on_copy;
    };
    double distance = 0, lo = 0, hi = 0;
    Pair triangles{~0u, ~0u};
    std::optional<Points> points{};
};

/// The class of contenders of `collide` that also give the contact's point, normal and depth.
inline const std::string with_contact_class = "with a contact";
/// The class of contenders of `distance` that begin each pose at the triangles of the one before.
inline const std::string warm_start_class = "warm start";

/// Where two triangles meet in one of the scene's poses: the copy leaves the mesh there if it is
/// moved by depth * normal. In the mesh's frame; the normal is of length 1.
struct PosedContact {
    Vec3<double> point, normal;
    double depth = 0;
    PosedPair triangles{};
};

/// Deepest first within a pose, then by triangles.
inline bool is_before(const PosedContact& x, const PosedContact& y) {
    if (x.triangles.pose != y.triangles.pose)
        return x.triangles.pose < y.triangles.pose;
    return x.depth != y.depth ? x.depth > y.depth : x.triangles < y.triangles;
}

/// The copy moves from pose i to this one, in a round.
constexpr std::size_t next_pose(std::size_t i, std::size_t n_poses) {
    return i + 1 < n_poses ? i + 1 : 0;
}

/// Whether the copy meets the mesh on its way from one pose to the next.
enum class Meets : std::uint8_t { no, yes, left_open };

/// Of one motion: up to t_free they do not touch, and at t_hit they are within the tolerance.
struct FirstMeeting {
    double t_free = 1, t_hit = 1;
    Meets meets = Meets::no;
};

} // namespace boxwood::bench
