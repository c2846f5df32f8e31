#include "bench/peers/coal/module.h"
#include "bench/peers/coal/conversions.h"
#include "bench/peers/each_case.h"
#include "bench/replay/replayer.h"
#include "trees/adapters/apis/coal_api.h"

#include <coal/broadphase/broadphase.h>
#include <coal/collision.h>
#include <coal/internal/intersect.h>
#include <coal/shape/geometric_shapes.h>

#include <array>
#include <cmath>

namespace boxwood::bench {
namespace {

/// A geometry that is nothing but its bounds: Coal's Box would round them.
class Bounds final : public coal::CollisionGeometry {
  public:
    explicit Bounds(const Aabb<float>& box) { take(box); }
    void take(const Aabb<float>& box) {
        aabb_local.min_ = vector(Vec3<double>(box.min));
        aabb_local.max_ = vector(Vec3<double>(box.max));
        computeLocalAABB();
    }
    void computeLocalAABB() override {
        aabb_center = aabb_local.center();
        aabb_radius = (aabb_local.max_ - aabb_center).norm();
    }
    Bounds* clone() const override { return new Bounds(*this); }

  private:
    bool isEqual(const coal::CollisionGeometry& other) const override {
        return dynamic_cast<const Bounds*>(&other) != nullptr; // the base compares the boxes
    }
};

struct Append final : coal::CollisionCallBackBase {
    std::vector<Pair>& pairs;
    bool compares; ///< whether the boxes are still to be compared

    Append(std::vector<Pair>& pairs_, bool compares_) : pairs(pairs_), compares(compares_) {}
    bool collide(coal::CollisionObject* a, coal::CollisionObject* b) override {
        if (!compares || a->getAABB().overlap(b->getAABB()))
            pairs.push_back(ordered_pair(item_of(a), item_of(b)));
        return false; // go on
    }
};

using Managers = coal::BroadPhaseCollisionManager;

/// level: 0 splits at the median, from the top; 2 in Morton order.
template <class M> std::unique_ptr<Managers> tree(int level) {
    auto made = std::make_unique<M>();
    made->tree_init_level = level;
    return made;
}

struct Kind {
    using Object = coal::CollisionObject;
    using Manager = Managers;
    using Bounds = bench::Bounds;

    CoalManager manager;
    Reported reported;

    std::unique_ptr<Manager> make(const std::vector<Aabb<float>>& boxes) const {
        switch (manager) {
        case CoalManager::tree:
            return tree<coal::DynamicAABBTreeCollisionManager>(2);
        case CoalManager::tree_median:
            return tree<coal::DynamicAABBTreeCollisionManager>(0);
        case CoalManager::tree_array:
            return tree<coal::DynamicAABBTreeArrayCollisionManager>(2);
        case CoalManager::tree_array_median:
            return tree<coal::DynamicAABBTreeArrayCollisionManager>(0);
        case CoalManager::sap:
            return std::make_unique<coal::SaPCollisionManager>();
        case CoalManager::ssap:
            return std::make_unique<coal::SSaPCollisionManager>();
        case CoalManager::interval_tree:
            return std::make_unique<coal::IntervalTreeCollisionManager>();
        case CoalManager::hash:
            break;
        }
        const HashGrid grid = hash_grid(boxes);
        return std::make_unique<coal::SpatialHashingCollisionManager<>>(
            grid.cell, vector(grid.limits.min), vector(grid.limits.max), grid.slots);
    }
    void collide(Manager& one, std::vector<Pair>& pairs) const {
        Append append(pairs, manager == CoalManager::hash);
        one.collide(&append);
    }
    void collide(Manager& one, Manager& other, std::vector<Pair>& pairs) const {
        Append append(pairs, manager == CoalManager::hash);
        one.collide(&other, &append);
    }
};

/// What a user who asks often about two triangles keeps.
template <bool contact> struct Shapes {
    coal::TriangleP a, b;
    coal::ComputeCollision compute{&a, &b};
    coal::CollisionRequest request;
    coal::CollisionResult result;

    explicit Shapes(const TrianglePairCase& c)
        : a(vector(c.a.a), vector(c.a.b), vector(c.a.c)),
          b(vector(c.b.a), vector(c.b.b), vector(c.b.c)) {
        request.enable_contact = contact;
    }
    Shapes(const Shapes&) = delete; // `compute` points to a and b
    Shapes& operator=(const Shapes&) = delete;
};
template <bool contact> struct KeptShapes {
    std::unique_ptr<Shapes<contact>> shapes;
    explicit KeptShapes(const TrianglePairCase& c) : shapes(std::make_unique<Shapes<contact>>(c)) {}
};

template <bool contact> Decision collide(KeptShapes<contact>& kept) {
    Shapes<contact>& of = *kept.shapes;
    of.result.clear();
    const coal::Transform3s in_place;
    return yes_or_no(of.compute(in_place, in_place, of.request, of.result) > 0);
}

struct Corners {
    std::array<coal::Vec3s, 3> a, b;
    explicit Corners(const TrianglePairCase& c)
        : a{vector(c.a.a), vector(c.a.b), vector(c.a.c)}, b{vector(c.b.a), vector(c.b.b),
                                                            vector(c.b.c)} {}
};

Distance distance(const Corners& of) {
    coal::Vec3s on_a, on_b;
    return plain_distance(
        std::sqrt(coal::TriangleDistance::sqrTriDistance(of.a.data(), of.b.data(), on_a, on_b)));
}

std::unique_ptr<Contender> make_manager(const Job& job, Sides sides, CoalManager manager,
                                        Reported reported) {
    return std::make_unique<ManagerContender<Kind>>(job, sides, Kind{manager, reported});
}

std::unique_ptr<Replay> make_replay(const RecordedProgram& program,
                                    std::optional<CoalManager> manager, bool with_shapes) {
    const auto make = [=]() -> std::unique_ptr<Managers> {
        if (!manager)
            return std::make_unique<CoalBroadPhase>();
        return Kind{*manager, Reported::all_may_have_moved}.make({});
    };
    if (with_shapes)
        return make_coal_shape_replay(program, make);
    return std::make_unique<Replayer<CoalApi>>(program, make);
}

std::unique_ptr<Contender> make_kernel(const Job& job, CoalKernel kernel) {
    switch (kernel) {
    case CoalKernel::collide:
        return over_cases<TrianglePairCase, KeptShapes<false>, collide<false>>(job);
    case CoalKernel::collide_with_contact:
        return over_cases<TrianglePairCase, KeptShapes<true>, collide<true>>(job);
    case CoalKernel::distance:
        return over_cases<TrianglePairCase, Corners, distance>(job);
    }
    return nullptr;
}

} // namespace
} // namespace boxwood::bench

extern "C" [[gnu::visibility("default")]] const boxwood::bench::CoalModule boxwood_coal;
const boxwood::bench::CoalModule boxwood_coal{
    boxwood::bench::make_manager,     boxwood::bench::make_kernel,
    boxwood::bench::make_coal_shapes, boxwood::bench::make_coal_meshes,
    boxwood::bench::make_coal_robot,  boxwood::bench::make_replay};
