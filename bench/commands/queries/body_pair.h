#pragma once

#include "kernels/convex/shapes.h"
#include "trees/world/continuous.h"
#include "trees/world/mesh_contacts.h"
#include "trees/world/mesh_pairs.h"
#include "trees/world/solid.h"

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace boxwood::bench {

/// Two bodies of a query, each a mesh, as its surface or as a solid, or a primitive, which is
/// solid. B stands at `b_in_a`, and answers are in A's frame. Triangles of primitives have the
/// number `no_triangle`. The triangles of a box with half sides that no float is are off by their
/// rounding: whether and when it touches and how far it is is then said of the box itself.
class BodyPair {
  public:
    static constexpr std::uint32_t no_triangle = ~0u;

    /// Each a mesh file or a primitive (read_primitive). A box is its surface, of 12 triangles, but
    /// solid beside a sphere, a capsule or a cylinder. solid: closed meshes and boxes are solids.
    /// Throws BadInput, and as load_mesh.
    BodyPair(const std::string& a, const std::string& b, bool solid);

    /// What decides whether they touch, and how far apart they are.
    std::string_view touch_kernel() const;
    std::string_view distance_kernel() const;

    /// What rounding leaves open touches.
    bool touch(const Pose& b_in_a) const;
    /// Sorted; of two primitives none.
    std::vector<Pair> touching_triangles(const Pose& b_in_a, std::size_t limit) const;
    /// 0 where they touch; of solids also where one lies in the other.
    MeshDistance distance(const Pose& b_in_a) const;
    MeshWithin within(const Pose& b_in_a, double tolerance) const;
    /// Where the surfaces touch; where one solid lies in the other one at the nearest points, whose
    /// depth is at most the true one.
    std::vector<Contact> contacts(const Pose& b_in_a, const ContactOptions& options) const;

    struct Path {
        Pose from, to;
    };
    FirstContact first_contact(const Path& a, const Path& b, MotionPath kind) const;

  private:
    using Body = std::variant<MeshTree, Solid, convex::Shape>;
    static Body read(const std::string& text, bool beside_round, bool solid);
    static const MeshTree* mesh(const Body& body); ///< none: a primitive
    bool is_certainly_apart(const Pose& b_in_a) const;
    std::vector<Contact> contacts_of_surfaces(const Pose& b_in_a,
                                              const ContactOptions& options) const;
    MeshDistance distance_of_surfaces(const Pose& b_in_a) const;
    MeshDistance distance_of_solid_boxes(const Pose& b_in_a) const;
    MeshDistance distance_of_meshes(const Pose& b_in_a) const;

    Body a_, b_;
    std::optional<convex::Shape> box_a_, box_b_; ///< those that are meshes here
    double rounded_ = 0;                         ///< how far their corners are off, together
};

} // namespace boxwood::bench
