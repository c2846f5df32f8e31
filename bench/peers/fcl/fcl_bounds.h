#pragma once

#include "bench/peers/managers.h"

#include <fcl/geometry/collision_geometry.h>
#include <fcl/narrowphase/collision_object.h>

namespace boxwood::bench {

/// A geometry that is nothing but its bounds. FCL's own Box would be placed by centre and size, and
/// its bounds would come back rounded: other boxes than ours, other pairs at a touch.
template <class S> class FclBounds final : public fcl::CollisionGeometry<S> {
  public:
    explicit FclBounds(const Aabb<float>& box) { take(box); }
    void take(const Aabb<float>& box) {
        for (int axis = 0; axis < 3; ++axis) {
            this->aabb_local.min_[axis] = static_cast<S>(box.min[axis]);
            this->aabb_local.max_[axis] = static_cast<S>(box.max[axis]);
        }
        computeLocalAABB();
    }
    void computeLocalAABB() override {
        this->aabb_center = this->aabb_local.center();
        this->aabb_radius = (this->aabb_local.max_ - this->aabb_center).norm();
    }
};

} // namespace boxwood::bench
