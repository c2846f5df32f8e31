#include "bench/peers/answering.h"
#include "bench/peers/bullet/bullet_volume.h"
#include "bench/peers/kernel_peers.h"
#include "bench/peers/mesh_peers.h"
#include "bench/peers/point_peers.h"
#include "scenes/moving/frames.h"

#include <fmt/format.h>

namespace boxwood::bench {
namespace {

static_assert(sizeof(btScalar) == sizeof(float), "the notes say single precision");

struct Append final : btDbvt::ICollide {
    explicit Append(std::vector<Pair>& pairs) : out(pairs) {}
    using ICollide::Process;
    void Process(const btDbvtNode* a, const btDbvtNode* b) override {
        out.push_back(ordered_pair(item_of(a), item_of(b)));
    }
    std::vector<Pair>& out;
};

/// The same where the leaves hold more than the boxes.
struct AppendFiltered final : btDbvt::ICollide {
    AppendFiltered(std::vector<Pair>& pairs, const std::vector<btDbvtVolume>& boxes)
        : out(pairs), volumes(boxes) {}
    using ICollide::Process;
    void Process(const btDbvtNode* a, const btDbvtNode* b) override {
        if (Intersect(volumes[item_of(a)], volumes[item_of(b)]))
            out.push_back(ordered_pair(item_of(a), item_of(b)));
    }
    std::vector<Pair>& out;
    const std::vector<btDbvtVolume>& volumes;
};

/// How leaves follow their boxes from frame to frame.
enum class Way {
    reinsert,            ///< each moved leaf inserted again
    top_down,            ///< rebuilt from the top
    incremental,         ///< each moved leaf inserted again, then one pass over all leaves
    reinsert_with_margin ///< each leaf inserted again, with a margin, once its box leaves it
};

class DbvtContender final : public Contender {
  public:
    DbvtContender(const Job& job, Sides sides, Way way)
        : scene_(*job.scene), way_(way), between_halves_(sides == Sides::two_halves),
          split_(between_halves_ ? tree_pairs_split(job.scene->boxes.size()) : 0) {
        leaves_.resize(scene_.boxes.size());
        take_boxes();
    }

    void build() override {
        first_.reset();
        rest_.reset();
        if (std::exchange(moved_, false))
            take_boxes();
        first_ = make_tree(0, split_);
        rest_ = make_tree(split_, volumes_.size());
    }

    void update(const Frame& now) override {
        moved_ = true;
        for (const std::uint32_t i : now.moved) {
            if (now.boxes[i].is_empty()) {
                rest_->remove(leaves_[i]);
                leaves_[i] = nullptr;
                continue;
            }
            volumes_[i] = volume_of(now.boxes[i]);
            btDbvtVolume volume = volumes_[i]; // changed by the calls below
            if (!leaves_[i])
                leaves_[i] = insert(*rest_, i);
            else if (way_ == Way::reinsert_with_margin)
                rest_->update(leaves_[i], volume, margin_);
            else if (way_ == Way::reinsert || way_ == Way::incremental)
                rest_->update(leaves_[i], volume);
            else
                leaves_[i]->volume = volume;
        }
        optimize(*rest_);
    }

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        Append append(pairs);
        AppendFiltered append_filtered(pairs, volumes_);
        const btDbvtNode* const side = between_halves_ ? first_->m_root : rest_->m_root;
        if (way_ == Way::reinsert_with_margin)
            rest_->collideTTpersistentStack(side, rest_->m_root, append_filtered);
        else
            rest_->collideTTpersistentStack(side, rest_->m_root, append);
    }

  private:
    /// Margins are a fifth of the mean side.
    void take_boxes() {
        volumes_.clear();
        for (const Aabb<float>& box : scene_.boxes)
            volumes_.push_back(volume_of(box));
        margin_ = .2f * mean_side(scene_.boxes);
    }

    btDbvtNode* insert(btDbvt& tree, std::size_t i) const {
        return tree.insert(volumes_[i], reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
    }

    void optimize(btDbvt& tree) const {
        if (way_ == Way::top_down)
            tree.optimizeTopDown(bottom_up_below);
        if (way_ == Way::incremental)
            tree.optimizeIncremental(tree.m_leaves);
    }

    std::unique_ptr<btDbvt> make_tree(std::size_t begin, std::size_t end) {
        auto tree = std::make_unique<btDbvt>();
        for (std::size_t i = begin; i < end; ++i)
            leaves_[i] = scene_.boxes[i].is_empty() ? nullptr : insert(*tree, i);
        optimize(*tree);
        return tree;
    }

    /// Sets of at most so many leaves are joined bottom-up, in cubic time (which forbids
    /// optimizeBottomUp of all): 32 was best for build and query together; Bullet's default of 128
    /// takes seven times as long to build, and 8 leaves a query 1.3 to 1.8 times as long.
    static constexpr int bottom_up_below = 32;

    const Scene& scene_;
    Way way_;
    bool between_halves_;
    std::size_t split_;
    std::vector<btDbvtVolume> volumes_; ///< the true ones
    std::vector<btDbvtNode*> leaves_;   ///< by item; null if it is not present
    btScalar margin_ = 0;
    bool moved_ = false;                   ///< whether the volumes are those of a frame
    std::unique_ptr<btDbvt> first_, rest_; ///< all boxes in `rest_` but for two halves
};

ContenderEntry entry(std::string name, std::string summary, std::string build, Way way) {
    ContenderEntry e;
    e.name = std::move(name);
    e.library = "bullet";
    e.summary = std::move(summary);
    e.notes = std::move(build) + "; bodies that come and go: insert, remove; query = collideTT "
                                 "with a virtual callback that appends the pair; one "
                                 "thread; a build also frees the tree before it";
    e.precision = "f32";
    e.runs_on = RunsOn::one_thread;
    e.answers = way == Way::reinsert_with_margin
                    ? std::vector{answering<DbvtContender>("moving_pairs", Sides::all, way)}
                    : answering_all_pairs<DbvtContender>(way);
    return e;
}

} // namespace

Peer bullet_peer() {
    Peer peer;
    peer.name = "bullet";
    peer.title = "Bullet";
    peer.summary = "Bullet Physics: dynamic bounding volume tree";
    peer.version = fmt::format("{}.{}", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100);
    peer.build = "the distribution's package: single precision, box tests without SSE";
    peer.contenders = {
        entry("bullet.dbvt", "Bullet's btDbvt, boxes inserted one by one",
              "build = insert each box, as Bullet's own broad phase does; no margin; a frame: "
              "update each moved leaf",
              Way::reinsert),
        entry("bullet.dbvt.top_down", "Bullet's btDbvt, rebuilt from the top after the insertions",
              "build = insert each box + optimizeTopDown(32); no margin; a frame: volumes of "
              "the moved leaves + optimizeTopDown(32)",
              Way::top_down),
        entry("bullet.dbvt.incremental",
              "Bullet's btDbvt, each leaf inserted once more after the insertions",
              "build = insert each box + optimizeIncremental(leaves): a build twice as long, "
              "for a query of 0.95 to 1.3 times the time of the leaves as inserted; no margin; "
              "a frame: update each moved leaf + optimizeIncremental(leaves)",
              Way::incremental),
        entry("bullet.dbvt.margin", "Bullet's btDbvt with margins that take up small moves",
              "build = insert each box; a frame: update each moved leaf with a "
              "margin of a fifth of the mean side; pairs filtered by the true boxes",
              Way::reinsert_with_margin)};
    for (ContenderEntry& e : bullet_broadphases())
        peer.contenders.push_back(std::move(e));
    for (ContenderEntry& e : bullet_points())
        peer.contenders.push_back(std::move(e));
    for (ContenderEntry& e : bullet_kernels())
        peer.contenders.push_back(std::move(e));
    for (ContenderEntry& e : bullet_meshes())
        peer.contenders.push_back(std::move(e));
    for (ContenderEntry& e : bullet_shapes())
        peer.contenders.push_back(std::move(e));
    return peer;
}

} // namespace boxwood::bench
