#include "bench/peers/answering.h"
#include "bench/peers/bullet/bullet_volume.h"
#include "bench/peers/point_peers.h"
#include "bench/peers/query_order.h"

#include <fmt/format.h>

namespace boxwood::bench {
namespace {

struct AppendItems final : btDbvt::ICollide {
    explicit AppendItems(const Scene& s) : scene(s) {}
    using ICollide::Process;
    void Process(const btDbvtNode* leaf) override {
        const std::uint32_t item = item_of(leaf);
        if (scene.spheres.empty() || meets(scene.spheres[query], scene.boxes[item]))
            out->push_back({query, item});
    }
    const Scene& scene;
    std::vector<Pair>* out = nullptr;
    std::uint32_t query = 0;
};

/// What is queried.
enum class Tree : std::uint8_t {
    top_down, ///< rebuilt from the top after the insertions
    inserted  ///< as the insertions left it
};

class CollideVolumes final : public Contender {
  public:
    CollideVolumes(const Job& job, PointQuery query, Tree kind, Asked asked)
        : scene_(*job.scene), kind_(kind), order_(job, query, asked) {
        for (const Aabb<float>& box : scene_.boxes)
            items_.push_back(volume_of(box));
        for (const Aabb<float>& box : query_boxes(scene_, query))
            queries_.push_back(volume_of(box));
    }

    void build() override {
        tree_.reset();
        tree_ = std::make_unique<btDbvt>();
        for (std::size_t i = 0; i < items_.size(); ++i)
            tree_->insert(items_[i], reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
        if (kind_ == Tree::top_down)
            tree_->optimizeTopDown(32); // a third faster to query, several times as long to build
    }

    void query(Answers& answers) override {
        order_.find();
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        AppendItems append(scene_);
        append.out = &pairs;
        for (std::size_t place = 0; place < order_.size(); ++place) {
            append.query = order_[place];
            tree_->collideTVNoStackAlloc(tree_->m_root, queries_[append.query], stack_, append);
        }
    }

  private:
    const Scene& scene_;
    Tree kind_;
    QueryOrder order_;
    std::vector<btDbvtVolume> items_, queries_;
    std::unique_ptr<btDbvt> tree_;
    btNodeStack stack_;
};

ContenderEntry collide_tv(Tree kind, Asked asked) {
    const bool is_inserted = kind == Tree::inserted;
    ContenderEntry e;
    e.name = "bullet.dbvt.collide_tv";
    if (is_inserted)
        e.name += ".inserted";
    e.name += name_of(asked);
    e.library = "bullet";
    e.summary = "Bullet's btDbvt queried with one volume after another";
    e.notes = fmt::format(
        "build = insert each box{}; query = collideTVNoStackAlloc with one stack for "
        "all and a virtual callback, {}; points are flat boxes; balls go by their boxes "
        "and are tested in doubles by the callback; one thread",
        is_inserted ? "" : " + optimizeTopDown(32)", words_for(asked));
    e.precision = "f32";
    e.runs_on = RunsOn::one_thread;
    e.classes = classes_of(asked);
    e.answers = {answering<CollideVolumes>("points", PointQuery::containing, kind, asked),
                 answering<CollideVolumes>("regions", PointQuery::overlapping, kind, asked)};
    return e;
}

} // namespace

std::vector<ContenderEntry> bullet_points() {
    std::vector<ContenderEntry> all;
    for (const Asked asked : {Asked::as_given, Asked::along_a_curve})
        for (const Tree kind : {Tree::top_down, Tree::inserted})
            all.push_back(collide_tv(kind, asked));
    return all;
}

} // namespace boxwood::bench
