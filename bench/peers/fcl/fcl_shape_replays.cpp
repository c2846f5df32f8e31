#include "bench/peers/replay_peers.h"
#include "bench/replay/shape_replayer.h"
#include "trees/adapters/apis/fcl_api.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
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
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace with_shapes {
namespace {

template <class S> using Manager = fcl::BroadPhaseCollisionManager<S>;
template <class S> using Shape = std::shared_ptr<fcl::CollisionGeometry<S>>;

template <class S> fcl::Vector3<S> vector(const Vec3<double>& v) {
    const Vec3<S> rounded(v);
    return {rounded.x, rounded.y, rounded.z};
}

template <class S>
Shape<S> mesh_of(const RecordedProgram& program, const RecordedProgram::Geometry& of) {
    std::vector<fcl::Vector3<S>> vertices;
    for (const Vec3<double>& vertex : program.vertices_of(of))
        vertices.push_back(vector<S>(vertex));
    std::vector<fcl::Triangle> triangles;
    for (const auto& [a, b, c] : program.triangles_of(of))
        triangles.emplace_back(a, b, c);
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSS<S>>>();
    model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
    model->addSubModel(vertices, triangles);
    model->endModel();
    return model;
}
template <class S>
Shape<S> convex_of(const RecordedProgram& program, const RecordedProgram::Geometry& of) {
    auto vertices = std::make_shared<std::vector<fcl::Vector3<S>>>();
    for (const Vec3<double>& vertex : program.vertices_of(of))
        vertices->push_back(vector<S>(vertex));
    auto faces = std::make_shared<std::vector<int>>();
    for (const auto& triangle : program.triangles_of(of)) {
        faces->push_back(3);
        for (const std::uint32_t corner : triangle)
            faces->push_back(static_cast<int>(corner));
    }
    return std::make_shared<fcl::Convex<S>>(vertices, static_cast<int>(of.n_triangles), faces);
}

template <class S> struct FclShapes {
    using Api = FclApi<S>;
    using Object = fcl::CollisionObject<S>;
    using Geometry = Shape<S>;
    using Rotation = fcl::Matrix3<S>;
    using Translation = fcl::Vector3<S>;

    static Geometry geometry_of(const RecordedProgram& program,
                                const RecordedProgram::Geometry& of) {
        const auto number = [&](std::size_t i) { return static_cast<S>(of.numbers[i]); };
        const S a = number(0), b = number(1), c = number(2), d = number(3);
        switch (of.shape) {
        case recording::Shape::box:
            return std::make_shared<fcl::Box<S>>(a, b, c);
        case recording::Shape::sphere:
            return std::make_shared<fcl::Sphere<S>>(a);
        case recording::Shape::ellipsoid:
            return std::make_shared<fcl::Ellipsoid<S>>(a, b, c);
        case recording::Shape::capsule:
            return std::make_shared<fcl::Capsule<S>>(a, b);
        case recording::Shape::cone:
            return std::make_shared<fcl::Cone<S>>(a, b);
        case recording::Shape::cylinder:
            return std::make_shared<fcl::Cylinder<S>>(a, b);
        case recording::Shape::plane:
            return std::make_shared<fcl::Plane<S>>(a, b, c, d);
        case recording::Shape::half_space:
            return std::make_shared<fcl::Halfspace<S>>(a, b, c, d);
        case recording::Shape::convex:
            return convex_of<S>(program, of);
        default:
            return mesh_of<S>(program, of);
        }
    }
    static bool touch(const Object* a, const Object* b, RecordedProgram::Touch touch) {
        const fcl::CollisionRequest<S> request(touch.max_contacts, touch.contacts);
        fcl::CollisionResult<S> result;
        return fcl::collide(a, b, request, result) > 0;
    }
    using Nearest = fcl::DistanceResult<S>;
    static double distance(const Object* a, const Object* b, Nearest& nearest) {
        const fcl::DistanceRequest<S> request;
        fcl::distance(a, b, request, nearest);
        return nearest.min_distance;
    }
};

template <class M, class S> std::unique_ptr<Manager<S>> plain() { return std::make_unique<M>(); }

template <class S>
ReplayEntry entry(std::string name, std::string library, const std::string& manager,
                  std::unique_ptr<Manager<S>> (*make_manager)()) {
    constexpr bool is_single = std::is_same_v<S, float>;
    const bool is_fcls = library == "fcl";
    const auto make = [=](const RecordedProgram& program) -> std::unique_ptr<Replay> {
        if (!program.knows_shapes() || !program.has_near_poses() ||
            ((is_fcls || is_single) && !program.has_near_bounds()))
            return nullptr;
        return std::make_unique<ShapeReplayer<FclShapes<S>>>(program, make_manager);
    };
    return {.name = std::move(name),
            .library = std::move(library),
            .summary =
                manager + " with fcl::collide and fcl::distance" + (is_single ? ", in floats" : ""),
            .make = make,
            .has_shapes = true,
            .in_floats = is_single};
}

template <class S> void append(std::vector<ReplayEntry>& all) {
    using fcl::DynamicAABBTreeCollisionManager, fcl::DynamicAABBTreeCollisionManager_Array;
    const std::string shapes = std::is_same_v<S, float> ? "_f32, FCL's shapes" : ", FCL's shapes";
    all.push_back(entry<S>("boxwood.fcl_manager" + shapes, "boxwood", "boxwood::FclBroadPhase",
                           plain<FclBroadPhase<S>, S>));
    all.push_back(entry<S>("fcl.dynamic_aabb_tree" + shapes, "fcl",
                           "DynamicAABBTreeCollisionManager",
                           plain<DynamicAABBTreeCollisionManager<S>, S>));
    all.push_back(entry<S>("fcl.dynamic_aabb_tree_array" + shapes, "fcl",
                           "DynamicAABBTreeCollisionManager_Array",
                           plain<DynamicAABBTreeCollisionManager_Array<S>, S>));
}

} // namespace
} // namespace with_shapes

std::vector<ReplayEntry> fcl_shape_replays() {
    std::vector<ReplayEntry> all;
    with_shapes::append<double>(all);
    with_shapes::append<float>(all);
    return all;
}

} // namespace boxwood::bench
