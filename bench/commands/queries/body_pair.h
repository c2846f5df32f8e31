#pragma once

#include "bench/commands/queries/bodies.h"
#include "trees/world/bodies/shape_pairs.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// Two bodies of a query (body_forms), of which B stands at `b_in_a`; answers are in A's frame.
/// What has no triangles or points has the number `no_part`; triangles have those of their files.
/// The triangles of a box with half sides that no float is are off by their rounding: whether and
/// when it touches and how far it is is then said of the box itself.
class BodyPair {
  public:
    static constexpr std::uint32_t no_part = ~0u;

    /// A box is its surface, of 12 triangles, where the other is a surface, too (is_surface_form).
    /// Throws as read_body.
    BodyPair(const std::string& a, const std::string& b, const BodyReading& how);

    /// What decides whether they touch, and how far apart they are.
    std::string_view touch_kernel() const;
    std::string_view distance_kernel() const;

    /// What rounding leaves open touches.
    bool touch(const Pose& b_in_a) const;
    /// Sorted; of two without triangles none.
    std::vector<Pair> touching_parts(const Pose& b_in_a, std::size_t limit) const;
    /// 0 where they touch; of solids also where one lies in the other.
    BodyDistance distance(const Pose& b_in_a, const DistanceOptions& options = {}) const;
    MeshWithin within(const Pose& b_in_a, double tolerance) const;
    /// Where the surfaces touch; where one solid lies in the other one at the nearest points, whose
    /// depth is at most the true one.
    std::vector<BodyContact> contacts(const Pose& b_in_a, const ContactOptions& options) const;

    struct Path {
        Pose from, to;
    };
    FirstContact first_contact(const Path& a, const Path& b, MotionPath kind) const;

  private:
    bool are_both_meshes() const { return a_.has_triangles() && b_.has_triangles(); }
    bool are_solid() const; ///< both, with what is inside
    BodyDistance distance_of(const BodyShape& a, const BodyShape& b, const Pose& b_in_a,
                             const DistanceOptions& options) const;
    BodyDistance distance_of_exact(const Pose& b_in_a, const DistanceOptions& options = {}) const;
    BodyDistance numbered(BodyDistance found) const;

    NamedBody a_, b_;
    BodyShape exact_a_, exact_b_; ///< boxes that are meshes here as convex shapes
    double rounded_ = 0;          ///< how far the corners of such boxes are off, together
};

} // namespace boxwood::bench
