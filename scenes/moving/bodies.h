#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/rigid_transform.h"
#include "kernels/primitives/triangle.h"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace boxwood {

inline constexpr std::uint32_t no_mesh = std::numeric_limits<std::uint32_t>::max();

/// The bodies of a moving scene at one moment, one element each per body. Scene units, seconds.
struct Bodies {
    std::vector<Aabb<float>> rest;            ///< the body's box in its own frame
    std::vector<std::uint32_t> mesh;          ///< its mesh among `meshes`, or no_mesh
    std::vector<RigidTransform<double>> pose; ///< from its own frame to the scene's
    std::vector<Vec3<double>> velocity;
    std::vector<std::uint8_t> present; ///< 0: not there, in no answer
    std::vector<TriangleMesh> meshes;  ///< each in its bodies' own frame
    Aabb<double> bounds;               ///< where effects keep the origins of bodies
    double side = 0;                   ///< mean of all sides of all boxes at the start
    double bounce = 1; ///< share of its speed towards a wall of the bounds that a body keeps there

    std::size_t size() const { return rest.size(); }
    /// So many mean body sides and so many mean sides of the bounds: how effects measure lengths.
    double length_of(double sides, double of_bounds) const {
        const Vec3<double> extent = bounds.max - bounds.min;
        return sides * side + of_bounds * (extent.x + extent.y + extent.z) / 3;
    }

    /// A body at rest whose own frame has its origin at the centre of the box.
    void add(const Aabb<float>& box);
    /// A body of a mesh that stands where the mesh does.
    void add(TriangleMesh mesh_of_it);
};

/// The bodies that one frame has changed, each once.
class Changed {
  public:
    explicit Changed(std::size_t n) : is_listed_(n) {}

    void add(std::uint32_t body) {
        if (is_listed_[body] == 0) {
            is_listed_[body] = 1;
            bodies_.push_back(body);
        }
    }
    void clear();
    /// Ascending, from the next call of `sort` on.
    std::span<const std::uint32_t> bodies() const { return bodies_; }
    void sort();

  private:
    std::vector<std::uint32_t> bodies_;
    std::vector<std::uint8_t> is_listed_;
};

/// The box of body i in the scene: contains the body whatever the rounding; empty if it is not
/// present. Source: the padded fit of kernels/boxes/fit.h.
Aabb<float> fitted_box(const Bodies& bodies, std::uint32_t i);

} // namespace boxwood
