#include "bench/peers/answering.h"
#include "bench/peers/fcl/fcl_bounds.h"
#include "bench/peers/point_peers.h"
#include "bench/peers/query_order.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fmt/format.h>

#include <cstdint>
#include <type_traits>

namespace boxwood::bench {
namespace {

/// level: 0 splits at the median, from the top; 2 in Morton order.
struct FclTree {
    int level;
    Asked asked;
};

template <class S> class QueryManager final : public Contender {
    using Object = fcl::CollisionObject<S>;
    using Manager = fcl::DynamicAABBTreeCollisionManager<S>;
    using Objects = std::vector<std::unique_ptr<Object>>;

  public:
    QueryManager(const Job& job, PointQuery query, FclTree tree)
        : scene_(*job.scene), query_(query), level_(tree.level), k_(neighbours_of(scene_)),
          order_(job, query, tree.asked), items_(objects_of(scene_.boxes)),
          queries_(objects_of(query_boxes(scene_, query))) {
        for (const std::unique_ptr<Object>& item : items_)
            registered_.push_back(item.get());
    }

    void build() override {
        tree_.reset();
        tree_ = std::make_unique<Manager>();
        tree_->tree_init_level = level_;
        tree_->registerObjects(registered_);
        tree_->setup();
    }

    void query(Answers& answers) override {
        order_.find();
        if (query_ == PointQuery::nearest)
            return find_nearest(list_of<Neighbour>(answers));
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        for (std::size_t place = 0; place < order_.size(); ++place) {
            const std::uint32_t i = order_[place];
            Query query{*this, i, &pairs, nullptr};
            tree_->collide(queries_[i].get(), &query, append);
        }
    }

  private:
    static Objects objects_of(const std::vector<Aabb<float>>& boxes) {
        Objects objects;
        for (std::size_t i = 0; i < boxes.size(); ++i)
            objects.push_back(object_for<Object>(std::make_shared<FclBounds<S>>(boxes[i]), i));
        return objects;
    }

    struct Query {
        const QueryManager& self;
        std::uint32_t number;
        std::vector<Pair>* pairs;
        NearestOfPeer* nearest;
    };

    void find_nearest(std::vector<Neighbour>& neighbours) {
        neighbours.resize(k_ * queries_.size());
        for (std::size_t place = 0; place < order_.size(); ++place) {
            const std::uint32_t i = order_[place];
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
    static bool offer(Object* a, Object* b, void* data, S& worst) {
        const Query& q = *static_cast<const Query*>(data);
        const Scene& scene = q.self.scene_;
        const std::uint32_t i = item(q, a, b);
        q.nearest->offer({i, squared_distance(scene.points[q.number], scene.boxes[i])});
        worst = rounded_up(std::sqrt(q.nearest->worst()));
        return worst == 0; // nothing can be nearer
    }

    /// In floats: bounds between boxes are rounded there, too, by some units in the last place.
    static S rounded_up(double distance) {
        if constexpr (std::is_same_v<S, float>)
            return static_cast<float>(distance) * (1 + 0x1p-20f);
        else
            return distance;
    }

    const Scene& scene_;
    PointQuery query_;
    int level_;
    std::size_t k_;
    QueryOrder order_;
    Objects items_, queries_;
    std::vector<Object*> registered_;
    std::unique_ptr<Manager> tree_;
};

template <class S> ContenderEntry query_manager(FclTree tree) {
    const bool is_single = std::is_same_v<S, float>;
    ContenderEntry e;
    e.name = fmt::format("fcl.dynamic_aabb_tree{}.object{}{}", is_single ? "_f32" : "",
                         tree.level == 0 ? ".median" : "", name_of(tree.asked));
    e.library = "fcl";
    e.summary = "FCL's DynamicAABBTreeCollisionManager queried with one object after another";
    e.notes = fmt::format(
        "tree_init_level {}; query = collide (nearest: distance) of an object that is nothing but "
        "its bounds with a callback; {}; boxes in {}; balls go by their boxes and are tested in "
        "doubles by the callback, distances found in doubles; one thread",
        tree.level, words_for(tree.asked),
        is_single ? "float, compiled here" : "double, equal to the scene's floats");
    e.precision = is_single ? "f32" : "f64";
    e.runs_on = RunsOn::one_thread;
    e.classes = classes_of(tree.asked);
    using Made = QueryManager<S>;
    e.answers = {answering<Made>("points", PointQuery::containing, tree),
                 answering<Made>("regions", PointQuery::overlapping, tree),
                 answering<Made>("nearest", PointQuery::nearest, tree)};
    return e;
}

} // namespace

std::vector<ContenderEntry> fcl_points() {
    std::vector<ContenderEntry> all;
    for (const Asked asked : {Asked::as_given, Asked::along_a_curve})
        for (const int level : {2, 0}) {
            all.push_back(query_manager<double>({level, asked}));
            all.push_back(query_manager<float>({level, asked}));
        }
    return all;
}

} // namespace boxwood::bench
