#pragma once

#include "trees/adapters/fcl_manager.h"

#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/collision_geometry.h>
#include <fcl/narrowphase/collision_object.h>

#include <memory>

namespace boxwood {

/// An object that is nothing but its bounds, which are exactly these and need no computeAABB.
template <class S> class FclBody final : public fcl::CollisionObject<S> {
  public:
    explicit FclBody(const fcl::AABB<S>& bounds, unsigned number = 0)
        : fcl::CollisionObject<S>(std::shared_ptr<fcl::CollisionGeometry<S>>(new Nothing)),
          number_(number) {
        move(bounds);
    }
    void move(const fcl::AABB<S>& bounds) { this->aabb = bounds; }
    unsigned number() const { return number_; }

  private:
    unsigned number_;
    struct Nothing final : fcl::CollisionGeometry<S> {
        void computeLocalAABB() override {}
    };
};

template <class S> struct FclApi {
    using Scalar = S;
    using Object = fcl::CollisionObject<S>;
    using Bounds = fcl::AABB<S>;
    using Body = FclBody<S>;
    using Manager = fcl::BroadPhaseCollisionManager<S>;
    using Ours = FclBroadPhase<S>;
    using Naive = fcl::NaiveCollisionManager<S>;
    using Tree = fcl::DynamicAABBTreeCollisionManager<S>;

    static constexpr bool tree_takes_flat = true;

    template <class Shown, class... Of>
    static void collide(const Manager& manager, Shown& shown, Of*... of) {
        manager.collide(of..., &shown, [](Object* a, Object* b, void* data) {
            return static_cast<Shown*>(data)->add(a, b);
        });
    }
    template <class Shown, class... Of>
    static void distance(const Manager& manager, Shown& shown, Of*... of) {
        manager.distance(of..., &shown, [](Object* a, Object* b, void* data, S& least) {
            return static_cast<Shown*>(data)->add(a, b, least);
        });
    }
};

} // namespace boxwood
