#include "bench/peers/replay_peers.h"
#include "bench/replay/replayer.h"
#include "trees/adapters/fcl_manager.h"

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

#include <algorithm>
#include <chrono>
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
Shape shape_of(const RecordedProgram& program, const RecordedProgram::Geometry& of) {
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

/// FCL's narrow phase by yes or no, and its distance without points, behind a manager.
class ShapeReplay final : public Replay {
  public:
    using Make = std::unique_ptr<Manager> (*)();

    ShapeReplay(const RecordedProgram& program, Make make) : program_(program), make_(make) {
        std::vector<Shape> shapes;
        for (const RecordedProgram::Geometry& geometry : program.geometries)
            shapes.push_back(shape_of(program, geometry));
        for (std::size_t i = 0; i < program.n_objects(); ++i) {
            objects_.push_back(std::make_unique<Object>(shapes[program.geometry_of[i]]));
            objects_.back()->setUserData(reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
        }
    }

    void run(const std::function<bool(std::size_t)>& includes,
             std::vector<ReplayedCall>& calls) override {
        calls.assign(program_.calls.size(), {});
        manager_ = make_();
        registered_.clear();
        for (std::size_t i = 0; i < calls.size(); ++i) {
            const RecordedProgram::Call& call = program_.calls[i];
            const bool is_asked = (!is_query(call.what) || includes(i)) &&
                                  !(is_of_one(call.what) && call.n_objects == 0);
            of_call_.clear();
            again_.clear();
            for (const std::uint32_t object : program_.objects_of(call))
                (registered_.take(call.what, object) ? of_call_ : again_)
                    .push_back(objects_[object].get());
            if (call.what == recording::Call::clear)
                registered_.clear();
            const auto begun = std::chrono::steady_clock::now();
            for (const RecordedProgram::State& state : program_.states_of(call))
                move(state);
            if (is_asked)
                answer(call, calls[i]);
            const std::chrono::duration<double, std::nano> taken =
                std::chrono::steady_clock::now() - begun;
            calls[i].ns = taken.count();
        }
        manager_.reset();
    }

  private:
    void move(const RecordedProgram::State& state) {
        Object& object = *objects_[state.object];
        fcl::Matrix3d rotation;
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                rotation(row, column) = state.pose[static_cast<std::size_t>(3 * row + column)];
        object.setTransform(rotation, {state.pose[9], state.pose[10], state.pose[11]});
        object.computeAABB();
    }
    static std::uint32_t number(const Object* object) {
        return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(object->getUserData()));
    }

    struct Touches {
        ReplayedCall& to;
        bool ends;
        static bool look(Object* a, Object* b, void* data) {
            auto& self = *static_cast<Touches*>(data);
            if (a == b)
                return false;
            const fcl::CollisionRequestd request;
            fcl::CollisionResultd result;
            if (fcl::collide(a, b, request, result) == 0)
                return false;
            ++self.to.shown;
            self.to.keys = recording::sum(self.to.keys, recording::key(number(a), number(b)));
            return self.ends;
        }
    };
    static bool measure(Object* a, Object* b, void* data, double& least) {
        auto& to = *static_cast<ReplayedCall*>(data);
        if (a == b)
            return false;
        const fcl::DistanceRequestd request;
        fcl::DistanceResultd result;
        fcl::distance(a, b, request, result);
        to.min_distance = std::min(to.min_distance, std::max(result.min_distance, 0.));
        least = to.min_distance;
        return least <= 0;
    }

    void answer(const RecordedProgram::Call& call, ReplayedCall& to) {
        using enum recording::Call;
        Touches touches{to, call.ended};
        switch (call.what) {
        case collide_self:
            return manager_->collide(&touches, Touches::look);
        case collide_object:
            return manager_->collide(of_call_[0], &touches, Touches::look);
        case distance_self:
            return manager_->distance(&to, measure);
        case distance_object:
            return manager_->distance(of_call_[0], &to, measure);
        default:
            change(*manager_, call.what, of_call_, again_);
        }
    }

    const RecordedProgram& program_;
    Make make_;
    std::vector<std::unique_ptr<Object>> objects_;
    Registrations registered_;
    std::vector<Object*> of_call_, again_;
    std::unique_ptr<Manager> manager_;
};

template <class M> std::unique_ptr<Manager> plain() { return std::make_unique<M>(); }

ReplayEntry entry(std::string name, std::string library, std::string summary,
                  ShapeReplay::Make make_manager) {
    const auto make = [make_manager](const RecordedProgram& program) -> std::unique_ptr<Replay> {
        if (!program.knows_shapes())
            return nullptr;
        return std::make_unique<ShapeReplay>(program, make_manager);
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
