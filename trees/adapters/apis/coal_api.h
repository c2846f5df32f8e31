#pragma once

#include "trees/adapters/coal_manager.h"

#include <coal/broadphase/broadphase_bruteforce.h>
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/collision_object.h>
#include <coal/shape/geometric_shapes.h>

#include <memory>

namespace boxwood {

/// An object that is nothing but its bounds, which are exactly these and need no computeAABB.
class CoalBody final : public coal::CollisionObject {
  public:
    explicit CoalBody(const coal::AABB& bounds, unsigned number = 0)
        : coal::CollisionObject(std::make_shared<coal::Sphere>(1)), number_(number) {
        move(bounds);
    }
    void move(const coal::AABB& bounds) { getAABB() = bounds; }
    unsigned number() const { return number_; }

  private:
    unsigned number_;
};

struct CoalApi {
    using Scalar = coal::CoalScalar;
    using Object = coal::CollisionObject;
    using Bounds = coal::AABB;
    using Body = CoalBody;
    using Manager = coal::BroadPhaseCollisionManager;
    using Ours = CoalBroadPhase;
    using Naive = coal::NaiveCollisionManager;
    using Tree = coal::DynamicAABBTreeCollisionManager;

    static constexpr bool tree_takes_flat = false; ///< throws for bounds of no volume

    template <class Shown> struct Show final : coal::CollisionCallBackBase {
        explicit Show(Shown& s) : shown(s) {}
        Shown& shown;
        bool collide(Object* a, Object* b) override { return shown.add(a, b); }
    };
    template <class Shown> struct Measure final : coal::DistanceCallBackBase {
        explicit Measure(Shown& s) : shown(s) {}
        Shown& shown;
        bool distance(Object* a, Object* b, Scalar& least) override {
            return shown.add(a, b, least);
        }
    };
    template <class Shown, class... Of>
    static void collide(const Manager& manager, Shown& shown, Of*... of) {
        Show<Shown> show(shown);
        manager.collide(of..., &show);
    }
    template <class Shown, class... Of>
    static void distance(const Manager& manager, Shown& shown, Of*... of) {
        Measure<Shown> measure(shown);
        manager.distance(of..., &measure);
    }
};

} // namespace boxwood
