#include "bench/peers/replay_peers.h"
#include "bench/replay/shape_replayer.h"
#include "trees/adapters/apis/fcl_api.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>

#include <memory>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace with_shapes {
namespace {

using Object = fcl::CollisionObjectd;
using Manager = fcl::BroadPhaseCollisionManagerd;
using Shape = std::shared_ptr<fcl::CollisionGeometryd>;

fcl::Vector3d vector(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

Shape mesh_of(const RecordedProgram& program, const RecordedProgram::Geometry& of) {
    std::vector<fcl::Vector3d> vertices;
    for (const Vec3<double>& vertex : program.vertices_of(of))
        vertices.push_back(vector(vertex));
    std::vector<fcl::Triangle> triangles;
    for (const auto& [a, b, c] : program.triangles_of(of))
        triangles.emplace_back(a, b, c);
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
    model->addSubModel(vertices, triangles);
    model->endModel();
    return model;
}
Shape convex_of(const RecordedProgram& program, const RecordedProgram::Geometry& of) {
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (const Vec3<double>& vertex : program.vertices_of(of))
        vertices->push_back(vector(vertex));
    auto faces = std::make_shared<std::vector<int>>();
    for (const auto& triangle : program.triangles_of(of)) {
        faces->push_back(3);
        for (const std::uint32_t corner : triangle)
            faces->push_back(static_cast<int>(corner));
    }
    return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(of.n_triangles), faces);
}
struct FclShapes {
    using Api = FclApi<double>;
    using Geometry = Shape;
    using Rotation = fcl::Matrix3d;
    using Translation = fcl::Vector3d;

    static Geometry geometry_of(const RecordedProgram& program,
                                const RecordedProgram::Geometry& of) {
        const auto [a, b, c, d] = of.numbers;
        switch (of.shape) {
        case recording::Shape::box:
            return std::make_shared<fcl::Boxd>(a, b, c);
        case recording::Shape::sphere:
            return std::make_shared<fcl::Sphered>(a);
        case recording::Shape::ellipsoid:
            return std::make_shared<fcl::Ellipsoidd>(a, b, c);
        case recording::Shape::capsule:
            return std::make_shared<fcl::Capsuled>(a, b);
        case recording::Shape::cone:
            return std::make_shared<fcl::Coned>(a, b);
        case recording::Shape::cylinder:
            return std::make_shared<fcl::Cylinderd>(a, b);
        case recording::Shape::plane:
            return std::make_shared<fcl::Planed>(a, b, c, d);
        case recording::Shape::half_space:
            return std::make_shared<fcl::Halfspaced>(a, b, c, d);
        case recording::Shape::convex:
            return convex_of(program, of);
        default:
            return mesh_of(program, of);
        }
    }
    static bool touch(const Object* a, const Object* b, RecordedProgram::Touch touch) {
        const fcl::CollisionRequestd request(touch.max_contacts, touch.contacts);
        fcl::CollisionResultd result;
        return fcl::collide(a, b, request, result) > 0;
    }
    using Nearest = fcl::DistanceResultd;
    static double distance(const Object* a, const Object* b, Nearest& nearest) {
        const fcl::DistanceRequestd request;
        fcl::distance(a, b, request, nearest);
        return nearest.min_distance;
    }
};

template <class M> std::unique_ptr<Manager> plain() { return std::make_unique<M>(); }

ReplayEntry entry(std::string name, std::string library, std::string summary,
                  std::unique_ptr<Manager> (*make_manager)()) {
    const auto make = [make_manager](const RecordedProgram& program) -> std::unique_ptr<Replay> {
        if (!program.knows_shapes())
            return nullptr;
        return std::make_unique<ShapeReplayer<FclShapes>>(program, make_manager);
    };
    return {.name = std::move(name),
            .library = std::move(library),
            .summary = std::move(summary),
            .make = make,
            .has_shapes = true};
}

} // namespace
} // namespace with_shapes

std::vector<ReplayEntry> fcl_shape_replays() {
    using with_shapes::entry, with_shapes::plain;
    return {entry("boxwood.fcl_manager, FCL's shapes", "boxwood",
                  "boxwood::FclBroadPhase with fcl::collide and fcl::distance",
                  plain<FclBroadPhase<double>>),
            entry("fcl.dynamic_aabb_tree, FCL's shapes", "fcl",
                  "DynamicAABBTreeCollisionManager with fcl::collide and fcl::distance",
                  plain<fcl::DynamicAABBTreeCollisionManagerd>)};
}

} // namespace boxwood::bench
