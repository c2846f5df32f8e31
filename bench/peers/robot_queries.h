#pragma once

#include "bench/tasks/contender.h"
#include "bench/tasks/detail/robot_in_scene.h"
#include "bench/tasks/detail/tree_task.h"
#include "kernels/primitives/rotation.h"

#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

/// Self-collision of a robot by the models, objects and manager of a library, L, written once for
/// FCL and Coal. L is made of std::vector<TriangleMesh> and has:
///     build(): a model of each mesh, made again
///     Object, with setUserData, getUserData, getAABB().overlap
///     make(geometry of a link, number of its mesh if it is one) -> unique_ptr<Object>
///     place(object, pose): its transform and its box
///     touch(object, object) -> bool
///     Manager, with registerObject, setup, update, clear
///     collide(manager, f): of each pair f(object, object), until that is true
namespace boxwood::bench {

/// Where the pairs of links come from: the library's manager, or a list that is made beforehand.
enum class LinkPairs : std::uint8_t { by_manager, listed };

/// Which links may touch, as a table that a callback reads.
class MayTouch {
  public:
    explicit MayTouch(const AllowedPairs& pairs)
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

/// All shapes of a robot; those that name one mesh in one scale share it.
struct LinkShapes {
    struct Shape {
        LinkGeometry geometry;
        std::size_t link;
        std::size_t mesh; ///< of `meshes`, if it is one
    };
    std::vector<TriangleMesh> meshes;
    std::vector<Shape> shapes;

    explicit LinkShapes(const RobotInScene& of) {
        std::map<std::tuple<std::uint32_t, double, double, double>, std::size_t> scaled_meshes;
        const auto links = of.robot.links();
        for (std::size_t i = 0; i < links.size(); ++i)
            for (const LinkGeometry& geometry : links[i].geometries) {
                shapes.push_back({geometry, i, 0});
                const auto* mesh = std::get_if<LinkMesh>(&geometry.shape);
                if (!mesh)
                    continue;
                const auto [seen, is_new] = scaled_meshes.try_emplace(
                    {mesh->mesh, mesh->scale.x, mesh->scale.y, mesh->scale.z}, meshes.size());
                shapes.back().mesh = seen->second;
                if (is_new)
                    meshes.push_back(scaled(of.meshes()[mesh->mesh], mesh->scale));
            }
    }
};

template <class L> class RobotQueries final : public Contender {
  public:
    using Object = typename L::Object;

    RobotQueries(RobotInScene robot, LinkPairs pairs)
        : robot_(std::move(robot)), shapes_(robot_), may_touch_(robot_.allowed),
          poses_(robot_.robot.links().size()), by_manager_(pairs == LinkPairs::by_manager),
          library_(shapes_.meshes) {
        const auto& shapes = shapes_.shapes;
        for (std::uint32_t i = 0; i < shapes.size(); ++i)
            for (std::uint32_t j = i + 1; j < shapes.size(); ++j)
                if (!may_touch_(shapes[i].link, shapes[j].link))
                    pairs_.push_back({i, j});
    }
    RobotQueries(const Job& job, LinkPairs pairs) : RobotQueries(RobotInScene(*job.scene), pairs) {}

    void build() override {
        manager_.clear();
        objects_.clear();
        touched_last_ = 0;
        library_.build();
        for (LinkShapes::Shape& shape : shapes_.shapes) {
            objects_.push_back(library_.make(shape.geometry, shape.mesh));
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
            const LinkShapes::Shape& shape = shapes_.shapes[i];
            L::place(*objects_[i], compose(poses_[shape.link], shape.geometry.origin));
        }
    }
    static std::size_t link_of(const Object& object) {
        return static_cast<const LinkShapes::Shape*>(object.getUserData())->link;
    }
    bool found_by_manager() {
        manager_.update();
        bool found = false;
        L::collide(manager_, [&](Object* a, Object* b) {
            return found = !may_touch_(link_of(*a), link_of(*b)) && library_.touch(a, b);
        });
        return found;
    }
    bool found_pair_by_pair() {
        const auto touch = [&](std::size_t i) {
            const auto [a, b] = pairs_[i];
            return objects_[a]->getAABB().overlap(objects_[b]->getAABB()) &&
                   library_.touch(objects_[a].get(), objects_[b].get());
        };
        const std::size_t first = touched_last_; // as ours
        if (first < pairs_.size() && touch(first))
            return true;
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            if (i != first && touch(i)) {
                touched_last_ = i;
                return true;
            }
        return false;
    }

    RobotInScene robot_;
    LinkShapes shapes_;
    MayTouch may_touch_;
    std::vector<Pair> pairs_;                   ///< of shapes whose links must not touch
    std::size_t touched_last_ = 0;              ///< in pairs_
    std::vector<RigidTransform<double>> poses_; ///< of the links
    bool by_manager_;
    L library_;
    std::vector<std::unique_ptr<Object>> objects_; ///< outlive their manager's use
    typename L::Manager manager_;
};

/// What follows "pairs" in the rows.
inline constexpr const char* listed_pairs =
    "of which the boxes overlap, one by one of a list that is made beforehand, without those that "
    "may touch, that which touched last first";
inline constexpr const char* managed_pairs =
    "from DynamicAABBTreeCollisionManager after update() of all, less those that a table of bytes "
    "allows to touch";

} // namespace boxwood::bench
