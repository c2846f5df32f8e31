#include "bench/peers/answering.h"
#include "bench/peers/fcl_bounds.h"
#include "bench/peers/point_peers.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <cstdint>

namespace boxwood::bench {
namespace {

using Object = fcl::CollisionObject<double>;
using Manager = fcl::DynamicAABBTreeCollisionManager<double>;

std::vector<std::unique_ptr<Object>> objects_of(const std::vector<Aabb<float>>& boxes) {
    std::vector<std::unique_ptr<Object>> objects;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        objects.push_back(object_for<Object>(std::make_shared<FclBounds<double>>(boxes[i]), i));
    return objects;
}

class QueryManager final : public Contender {
  public:
    QueryManager(const Job& job, PointQuery query)
        : scene_(*job.scene), query_(query), k_(neighbours_of(scene_)),
          items_(objects_of(scene_.boxes)), queries_(objects_of(query_boxes(scene_, query))) {
        for (const std::unique_ptr<Object>& item : items_)
            registered_.push_back(item.get());
    }

    void build() override {
        tree_ = std::make_unique<Manager>();
        tree_->tree_init_level = 2;
        tree_->registerObjects(registered_);
        tree_->setup();
    }

    void query(Answers& answers) override {
        if (query_ == PointQuery::nearest)
            return find_nearest(list_of<Neighbour>(answers));
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        for (std::uint32_t i = 0; i < queries_.size(); ++i) {
            Query query{*this, i, &pairs, nullptr};
            tree_->collide(queries_[i].get(), &query, append);
        }
    }

  private:
    struct Query {
        const QueryManager& self;
        std::uint32_t number;
        std::vector<Pair>* pairs;
        NearestOfPeer* nearest;
    };

    void find_nearest(std::vector<Neighbour>& neighbours) {
        neighbours.resize(k_ * queries_.size());
        for (std::uint32_t i = 0; i < queries_.size(); ++i) {
            NearestOfPeer nearest(std::span<Neighbour>(neighbours).subspan(i * k_, k_));
            Query query{*this, i, nullptr, &nearest};
            tree_->distance(queries_[i].get(), &query, offer);
        }
    }

    /// The item of the two: the other is the query itself.
    static std::uint32_t item(const Query& q, const Object* a, const Object* b) {
        const Object* own = q.self.queries_[q.number].get();
        return item_of(a == own ? b : a);
    }
    static bool append(Object* a, Object* b, void* data) {
        const Query& q = *static_cast<const Query*>(data);
        const Scene& scene = q.self.scene_;
        const std::uint32_t i = item(q, a, b);
        if (scene.spheres.empty() || meets(scene.spheres[q.number], scene.boxes[i]))
            q.pairs->push_back({q.number, i});
        return false; // go on
    }
    static bool offer(Object* a, Object* b, void* data, double& worst) {
        const Query& q = *static_cast<const Query*>(data);
        const Scene& scene = q.self.scene_;
        const std::uint32_t i = item(q, a, b);
        q.nearest->offer({i, squared_distance(scene.points[q.number], scene.boxes[i])});
        worst = std::sqrt(q.nearest->worst());
        return worst == 0; // nothing can be nearer
    }

    const Scene& scene_;
    PointQuery query_;
    std::size_t k_;
    std::vector<std::unique_ptr<Object>> items_, queries_;
    std::vector<Object*> registered_;
    std::unique_ptr<Manager> tree_;
};

} // namespace

std::vector<ContenderEntry> fcl_points() {
    ContenderEntry e;
    e.name = "fcl.dynamic_aabb_tree.object";
    e.library = "fcl";
    e.summary = "FCL's DynamicAABBTreeCollisionManager queried with one object after another";
    e.notes = "tree_init_level 2; query = collide (nearest: distance) of an object that is nothing "
              "but its bounds with a callback; balls go by their boxes and are tested in doubles "
              "by the callback; one thread";
    e.precision = "f64";
    e.runs_on = RunsOn::one_thread;
    e.answers = {answering<QueryManager>("points", PointQuery::containing),
                 answering<QueryManager>("regions", PointQuery::overlapping),
                 answering<QueryManager>("nearest", PointQuery::nearest)};
    return {e};
}

} // namespace boxwood::bench
