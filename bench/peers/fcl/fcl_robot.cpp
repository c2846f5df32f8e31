#include "bench/peers/answering.h"
#include "bench/peers/fcl/mesh_models.h"
#include "bench/peers/mesh_peers.h"
#include "bench/peers/robot_queries.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>
#include <fmt/format.h>

#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace boxwood::bench {
namespace {

/// As bench/peers/robot_queries.h asks.
template <class Volume> class FclLinks {
  public:
    using S = typename Volume::S;
    using Object = fcl::CollisionObject<S>;
    using Manager = fcl::DynamicAABBTreeCollisionManager<S>;

    explicit FclLinks(const std::vector<TriangleMesh>& meshes)
        : meshes_(meshes.begin(), meshes.end()) {}

    void build() {
        models_.clear();
        for (const MeshOfFcl<S>& mesh : meshes_) {
            models_.push_back(std::make_shared<fcl::BVHModel<Volume>>());
            mesh.build(*models_.back());
        }
    }
    std::unique_ptr<Object> make(const LinkGeometry& geometry, std::size_t mesh) const {
        return std::make_unique<Object>(std::visit(GeometryOf{models_, mesh}, geometry.shape));
    }
    static void place(Object& object, const RigidTransform<double>& pose) {
        object.setTransform(transform_of<S>(pose));
        object.computeAABB();
    }
    bool touch(Object* a, Object* b) {
        result_.clear();
        return fcl::collide(a, b, request_, result_) > 0;
    }
    template <class F> static void collide(Manager& manager, F f) {
        manager.collide(&f, [](Object* a, Object* b, void* of) {
            return (*static_cast<F*>(of))(a, b); // true ends it
        });
    }

  private:
    using Geometry = std::shared_ptr<fcl::CollisionGeometry<S>>;
    using Models = std::vector<std::shared_ptr<fcl::BVHModel<Volume>>>;

    /// FCL's shape for a link's, its frame included.
    struct GeometryOf {
        const Models& models;
        std::size_t mesh;

        Geometry operator()(const LinkMesh&) const { return models[mesh]; }
        Geometry operator()(const LinkBox& shape) const {
            return std::make_shared<fcl::Box<S>>(of(shape.sides.x), of(shape.sides.y),
                                                 of(shape.sides.z));
        }
        Geometry operator()(const LinkSphere& shape) const {
            return std::make_shared<fcl::Sphere<S>>(of(shape.radius));
        }
        Geometry operator()(const LinkCylinder& shape) const {
            return std::make_shared<fcl::Cylinder<S>>(of(shape.radius), of(shape.length));
        }
        Geometry operator()(const LinkCapsule& shape) const {
            return std::make_shared<fcl::Capsule<S>>(of(shape.radius), of(shape.length));
        }
        static S of(double x) { return static_cast<S>(x); }
    };

    std::vector<MeshOfFcl<S>> meshes_;
    Models models_;
    fcl::CollisionRequest<S> request_{1, false};
    fcl::CollisionResult<S> result_;
};

template <class Volume>
ContenderEntry robot_row(const std::string& name, LinkPairs pairs, const std::string& how) {
    using Name = VolumeName<Volume>;
    ContenderEntry e;
    e.name = "fcl.robot." + name;
    if (Name::word() != "obbrss")
        e.name += "." + Name::word();
    e.library = "fcl";
    e.summary = fmt::format("FCL's BVHModel of {} for each link's mesh and its shapes for solids, "
                            "{}pairs {}",
                            Name::title(), Name::is_single ? "in floats, " : "", how);
    e.notes = fmt::format("build = a model of each mesh, and objects; query = state after state, "
                          "our forward kinematics, objects placed, pairs {}, until two touch that "
                          "must not; collide for one contact without its point; {}; one thread",
                          how, Name::is_single ? "floats, compiled here" : "doubles");
    e.precision = Name::is_single ? "f32" : "f64";
    e.runs_on = RunsOn::one_thread;
    e.answers = {answering<RobotQueries<FclLinks<Volume>>>("robot_self", pairs)};
    return e;
}

template <class Volume> void append_robots(std::vector<ContenderEntry>& all) {
    all.push_back(robot_row<Volume>("manager", LinkPairs::by_manager, managed_pairs));
    all.push_back(robot_row<Volume>("pairs", LinkPairs::listed, listed_pairs));
}

} // namespace

std::vector<ContenderEntry> fcl_robots() {
    std::vector<ContenderEntry> all;
    append_robots<fcl::OBBRSSd>(all);
    append_robots<fcl::OBBd>(all);
    append_robots<fcl::OBBRSSf>(all);
    append_robots<fcl::OBBf>(all);
    return all;
}

} // namespace boxwood::bench
