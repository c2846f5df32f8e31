#include "bench/peers/answering.h"
#include "bench/peers/fcl/mesh_models.h"
#include "bench/peers/mesh_peers.h"
#include "bench/tasks/detail/robot_in_scene.h"
#include "kernels/primitives/rotation.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>
#include <fmt/format.h>

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

namespace boxwood::bench {
namespace {

/// Which links may touch, as a table that a callback reads.
class Allowed {
  public:
    explicit Allowed(const AllowedPairs& pairs)
        : n_(pairs.items()), is_allowed_(n_ * n_, std::uint8_t{1}) {
        for (std::uint32_t a = 0; a < n_; ++a)
            for (std::uint32_t b = 0; b < n_; ++b)
                if (a != b)
                    is_allowed_[a * n_ + b] = pairs.allows(a, b);
    }
    bool operator()(std::size_t a, std::size_t b) const { return is_allowed_[a * n_ + b] != 0; }

  private:
    std::size_t n_;
    std::vector<std::uint8_t> is_allowed_;
};

struct Shape {
    LinkGeometry geometry;
    std::size_t link;
    std::size_t mesh; ///< of LinkShapes::meshes, if it is one
};

/// All shapes of a robot; those that name one mesh in one scale share it.
template <class S> struct LinkShapes {
    std::vector<MeshOfFcl<S>> meshes;
    std::vector<Shape> shapes;

    explicit LinkShapes(const RobotInScene& of) {
        std::map<std::tuple<std::uint32_t, double, double, double>, std::size_t> scaled_meshes;
        const auto links = of.robot.links();
        for (std::size_t i = 0; i < links.size(); ++i)
            for (const LinkGeometry& geometry : links[i].geometries) {
                shapes.push_back({geometry, i, meshes.size()});
                const auto* mesh = std::get_if<LinkMesh>(&geometry.shape);
                if (!mesh)
                    continue;
                const auto [seen, is_new] = scaled_meshes.try_emplace(
                    {mesh->mesh, mesh->scale.x, mesh->scale.y, mesh->scale.z}, meshes.size());
                shapes.back().mesh = seen->second;
                if (is_new)
                    meshes.emplace_back(scaled(of.meshes()[mesh->mesh], mesh->scale));
            }
    }
};

/// FCL's shape for a link's, its frame included.
template <class Volume> struct GeometryOf {
    using S = typename Volume::S;
    const std::shared_ptr<fcl::BVHModel<Volume>>& model; ///< of a mesh

    using Geometry = std::shared_ptr<fcl::CollisionGeometry<S>>;
    Geometry operator()(const LinkMesh&) const { return model; }
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

  private:
    static S of(double x) { return static_cast<S>(x); }
};

enum class Pairs : std::uint8_t { by_manager, all };

template <class Volume> class SelfCollisions final : public Contender {
  public:
    using S = typename Volume::S;
    using Model = fcl::BVHModel<Volume>;
    using Object = fcl::CollisionObject<S>;

    SelfCollisions(const Job& job, Pairs pairs)
        : robot_(*job.scene), shapes_(robot_), allowed_(robot_.allowed),
          poses_(robot_.robot.links().size()), by_manager_(pairs == Pairs::by_manager) {
        const std::vector<Shape>& shapes = shapes_.shapes;
        for (std::uint32_t i = 0; i < shapes.size(); ++i)
            for (std::uint32_t j = i + 1; j < shapes.size(); ++j)
                if (!allowed_(shapes[i].link, shapes[j].link))
                    pairs_.push_back({i, j});
    }

    void build() override {
        manager_.clear();
        objects_.clear();
        touched_last_ = 0;
        std::vector<std::shared_ptr<Model>> models;
        for (const MeshOfFcl<S>& mesh : shapes_.meshes) {
            models.push_back(std::make_shared<Model>());
            mesh.build(*models.back());
        }
        models.emplace_back(); // what is no mesh may name it
        for (Shape& shape : shapes_.shapes) {
            objects_.push_back(std::make_unique<Object>(
                std::visit(GeometryOf<Volume>{models[shape.mesh]}, shape.geometry.shape)));
            objects_.back()->setUserData(&shape);
            if (by_manager_)
                manager_.registerObject(objects_.back().get());
        }
        if (by_manager_)
            manager_.setup();
    }
    void query(Answers& answers) override {
        std::vector<std::uint8_t>& collides = list_of<std::uint8_t>(answers);
        collides.clear();
        for (const std::vector<double>& state : robot_.states()) {
            place(state);
            collides.push_back(by_manager_ ? found_by_manager() : found_pair_by_pair());
        }
    }

  private:
    void place(const std::vector<double>& state) {
        robot_.robot.poses(state, poses_);
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            const Shape& shape = shapes_.shapes[i];
            objects_[i]->setTransform(
                transform_of<S>(compose(poses_[shape.link], shape.geometry.origin)));
            objects_[i]->computeAABB();
        }
    }
    static const Shape& shape_of(const Object& object) {
        return *static_cast<const Shape*>(object.getUserData());
    }
    bool touch(Object* a, Object* b) {
        result_.clear();
        return fcl::collide(a, b, request_, result_) > 0;
    }
    bool found_by_manager() {
        manager_.update();
        found_ = false;
        manager_.collide(this, [](Object* a, Object* b, void* self) {
            auto& of = *static_cast<SelfCollisions*>(self);
            return of.found_ = !of.allowed_(shape_of(*a).link, shape_of(*b).link) &&
                               of.touch(a, b); // true ends it
        });
        return found_;
    }
    bool found_pair_by_pair() {
        const auto overlap = [&](std::size_t i) {
            const auto [a, b] = pairs_[i];
            return objects_[a]->getAABB().overlap(objects_[b]->getAABB()) &&
                   touch(objects_[a].get(), objects_[b].get());
        };
        const std::size_t first = touched_last_; // as ours
        if (first < pairs_.size() && overlap(first))
            return true;
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            if (i != first && overlap(i)) {
                touched_last_ = i;
                return true;
            }
        return false;
    }

    RobotInScene robot_;
    LinkShapes<S> shapes_;
    Allowed allowed_;
    std::vector<Pair> pairs_;                   ///< of shapes whose links must not touch
    std::size_t touched_last_ = 0;              ///< in pairs_
    std::vector<RigidTransform<double>> poses_; ///< of the links
    bool by_manager_, found_ = false;
    std::vector<std::unique_ptr<Object>> objects_; ///< outlive their manager's use
    fcl::DynamicAABBTreeCollisionManager<S> manager_;
    fcl::CollisionRequest<S> request_{1, false};
    fcl::CollisionResult<S> result_;
};

template <class Volume>
ContenderEntry self_collisions(const std::string& name, Pairs pairs, const std::string& how) {
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
    e.answers = {answering<SelfCollisions<Volume>>("robot_self", pairs)};
    return e;
}

template <class Volume> void append_robots(std::vector<ContenderEntry>& all) {
    all.push_back(self_collisions<Volume>(
        "manager", Pairs::by_manager,
        "from DynamicAABBTreeCollisionManager after update() of all, less those that a table of "
        "bytes allows to touch"));
    all.push_back(self_collisions<Volume>(
        "pairs", Pairs::all,
        "of which the boxes overlap, one by one of a list that is made beforehand, without those "
        "that may touch, that which touched last first"));
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
