#include "bench/peers/coal/conversions.h"
#include "bench/peers/coal/module.h"
#include "bench/replay/shape_replayer.h"
#include "trees/adapters/apis/coal_api.h"

#include <coal/broadphase/broadphase.h>
#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include <memory>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

using Object = coal::CollisionObject;

MeshOfCoal mesh_of(const RecordedProgram& program, const RecordedProgram::Geometry& of) {
    return {program.vertices_of(of), program.triangles_of(of)};
}
std::shared_ptr<coal::CollisionGeometry> convex_of(MeshOfCoal of) {
    const auto n_points = static_cast<unsigned>(of.vertices.size()),
               n_faces = static_cast<unsigned>(of.triangles.size());
    return std::make_shared<coal::Convex<coal::Triangle>>(
        std::make_shared<std::vector<coal::Vec3s>>(std::move(of.vertices)), n_points,
        std::make_shared<std::vector<coal::Triangle>>(std::move(of.triangles)), n_faces);
}

struct CoalShapes {
    using Api = CoalApi;
    using Geometry = std::shared_ptr<coal::CollisionGeometry>;
    using Rotation = coal::Matrix3s;
    using Translation = coal::Vec3s;

    static Geometry geometry_of(const RecordedProgram& program,
                                const RecordedProgram::Geometry& of) {
        const auto [a, b, c, d] = of.numbers;
        switch (of.shape) {
        case recording::Shape::box:
            return std::make_shared<coal::Box>(a, b, c);
        case recording::Shape::sphere:
            return std::make_shared<coal::Sphere>(a);
        case recording::Shape::ellipsoid:
            return std::make_shared<coal::Ellipsoid>(a, b, c);
        case recording::Shape::capsule:
            return std::make_shared<coal::Capsule>(a, b);
        case recording::Shape::cone:
            return std::make_shared<coal::Cone>(a, b);
        case recording::Shape::cylinder:
            return std::make_shared<coal::Cylinder>(a, b);
        case recording::Shape::plane:
            return std::make_shared<coal::Plane>(a, b, c, d);
        case recording::Shape::half_space:
            return std::make_shared<coal::Halfspace>(a, b, c, d);
        case recording::Shape::convex:
            return convex_of(mesh_of(program, of));
        default:
            return mesh_of(program, of).model<coal::OBBRSS>();
        }
    }
    static bool touch(const Object* a, const Object* b, RecordedProgram::Touch touch) {
        coal::CollisionRequest request;
        request.enable_contact = touch.contacts;
        request.num_max_contacts = touch.max_contacts;
        request.break_distance = 0; // no lower bound of the distance is wanted
        request.distance_upper_bound = 0;
        coal::CollisionResult result;
        return coal::collide(a, b, request, result) > 0;
    }
    using Nearest = coal::DistanceResult;
    static double distance(const Object* a, const Object* b, Nearest& nearest) {
        coal::DistanceRequest request;
        request.enable_signed_distance = false;
        coal::distance(a, b, request, nearest);
        return nearest.min_distance;
    }
};

} // namespace

std::unique_ptr<Replay> make_coal_shape_replay(const RecordedProgram& program,
                                               MakeCoalManager make) {
    return std::make_unique<ShapeReplayer<CoalShapes>>(program, std::move(make));
}

} // namespace boxwood::bench
