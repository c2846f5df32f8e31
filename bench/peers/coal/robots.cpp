#include "bench/peers/coal/conversions.h"
#include "bench/peers/coal/module.h"

#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/collision.h>
#include <coal/shape/geometric_shapes.h>

#include <memory>
#include <utility>
#include <variant>
#include <vector>

namespace boxwood::bench {
namespace {

/// As bench/peers/robot_queries.h asks.
template <class Volume> class CoalLinks {
  public:
    using Object = coal::CollisionObject;
    using Manager = coal::DynamicAABBTreeCollisionManager;

    explicit CoalLinks(const std::vector<TriangleMesh>& meshes)
        : meshes_(meshes.begin(), meshes.end()) {
        request_.distance_upper_bound = 0; // GJK ends as soon as it knows that solids are apart
    }
    void build() {
        models_.clear();
        for (const MeshOfCoal& mesh : meshes_)
            models_.push_back(mesh.model<Volume>());
    }
    std::unique_ptr<Object> make(const LinkGeometry& geometry, std::size_t mesh) const {
        return std::make_unique<Object>(std::visit(GeometryOf{models_, mesh}, geometry.shape));
    }
    static void place(Object& object, const RigidTransform<double>& pose) {
        object.setTransform(transform_of(pose));
        object.computeAABB();
        coal::AABB& box = object.getAABB();
        if (!(box.volume() > 0)) // for which its trees throw
            box.expand(0x1p-40 * (1 + box.min_.norm() + box.max_.norm()));
    }
    bool touch(Object* a, Object* b) {
        result_.clear();
        return coal::collide(a, b, request_, result_) > 0;
    }
    template <class F> static void collide(Manager& manager, F f) {
        struct Call final : coal::CollisionCallBackBase {
            F& f;
            explicit Call(F& f_) : f(f_) {}
            bool collide(Object* a, Object* b) override { return f(a, b); } // true ends it
        } call(f);
        manager.collide(&call);
    }

  private:
    using Geometry = std::shared_ptr<coal::CollisionGeometry>;
    using Models = std::vector<std::shared_ptr<coal::BVHModel<Volume>>>;

    /// Coal's shape for a link's, its frame included.
    struct GeometryOf {
        const Models& models;
        std::size_t mesh;

        Geometry operator()(const LinkMesh&) const { return models[mesh]; }
        Geometry operator()(const LinkBox& shape) const {
            return std::make_shared<coal::Box>(shape.sides.x, shape.sides.y, shape.sides.z);
        }
        Geometry operator()(const LinkSphere& shape) const {
            return std::make_shared<coal::Sphere>(shape.radius);
        }
        Geometry operator()(const LinkCylinder& shape) const {
            return std::make_shared<coal::Cylinder>(shape.radius, shape.length);
        }
        Geometry operator()(const LinkCapsule& shape) const {
            return std::make_shared<coal::Capsule>(shape.radius, shape.length);
        }
    };

    std::vector<MeshOfCoal> meshes_;
    Models models_;
    coal::CollisionRequest request_ = request_of(1, false);
    coal::CollisionResult result_;
};

} // namespace

std::unique_ptr<Contender> make_coal_robot(RobotInScene robot, CoalVolume volume, LinkPairs pairs) {
    if (volume == CoalVolume::obb)
        return std::make_unique<RobotQueries<CoalLinks<coal::OBB>>>(std::move(robot), pairs);
    return std::make_unique<RobotQueries<CoalLinks<coal::OBBRSS>>>(std::move(robot), pairs);
}

} // namespace boxwood::bench
