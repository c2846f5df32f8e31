#include "bench/peers/capability.h"
#include "bench/peers/kernel_peers.h"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <fmt/format.h>

#include <cstdint>

namespace boxwood::bench {
namespace {

static_assert(sizeof(btScalar) == sizeof(float), "the notes say single precision");

std::uint32_t item(const btDbvtNode* leaf) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(leaf->data));
}

struct Append final : btDbvt::ICollide {
    explicit Append(std::vector<Pair>& pairs) : out(pairs) {}
    using ICollide::Process;
    void Process(const btDbvtNode* a, const btDbvtNode* b) override {
        out.push_back(ordered_pair(item(a), item(b)));
    }
    std::vector<Pair>& out;
};

class DbvtContender final : public Contender {
  public:
    DbvtContender(const Job& job, bool top_down)
        : top_down_(top_down), between_halves_(job.ask == Ask::tree_pairs),
          split_(between_halves_ ? tree_pairs_split(job.scene->boxes.size()) : 0) {
        volumes_.reserve(job.scene->boxes.size());
        for (const Aabb<float>& box : job.scene->boxes)
            volumes_.push_back(btDbvtVolume::FromMM(btVector3(box.min.x, box.min.y, box.min.z),
                                                    btVector3(box.max.x, box.max.y, box.max.z)));
    }

    void build() override {
        first_ = make_tree(0, split_);
        rest_ = make_tree(split_, volumes_.size());
    }

    void query(Answers& answers) override {
        answers.pairs.clear();
        Append append(answers.pairs);
        const btDbvtNode* const side = between_halves_ ? first_->m_root : rest_->m_root;
        rest_->collideTTpersistentStack(side, rest_->m_root, append);
    }

  private:
    std::unique_ptr<btDbvt> make_tree(std::size_t begin, std::size_t end) const {
        auto tree = std::make_unique<btDbvt>();
        for (std::size_t i = begin; i < end; ++i)
            tree->insert(volumes_[i], reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
        if (top_down_)
            tree->optimizeTopDown(bottom_up_below);
        return tree;
    }

    /// Sets of at most so many leaves are joined bottom-up, in cubic time: 32 was best for build
    /// and query together; Bullet's default of 128 takes seven times as long to build.
    static constexpr int bottom_up_below = 32;

    bool top_down_, between_halves_;
    std::size_t split_;
    std::vector<btDbvtVolume> volumes_;
    std::unique_ptr<btDbvt> first_, rest_; ///< all boxes in `rest_` for Ask::pairs
};

ContenderEntry entry(std::string name, std::string summary, std::string build, bool top_down) {
    ContenderEntry e;
    e.name = std::move(name);
    e.library = "bullet";
    e.summary = std::move(summary);
    e.notes = std::move(build) +
              "; query = collideTT with a virtual callback that appends the pair; no margin; one "
              "thread; a build also frees the tree before it";
    e.precision = "f32";
    e.unsupported = [](const Job& job) -> Unsupported {
        if (auto why = not_box_ask(job))
            return why;
        return not_serial(job);
    };
    e.make = [top_down](const Job& job) { return std::make_unique<DbvtContender>(job, top_down); };
    return e;
}

} // namespace

Peer bullet_peer() {
    Peer peer;
    peer.name = "bullet";
    peer.summary = "Bullet Physics: dynamic bounding volume tree";
    peer.version = fmt::format("{}.{}", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100);
    peer.build = "the distribution's package: single precision, box tests without SSE";
    peer.contenders = {entry("bullet.dbvt", "Bullet's btDbvt, boxes inserted one by one",
                             "build = insert each box, as Bullet's own broad phase does", false),
                       entry("bullet.dbvt.top_down",
                             "Bullet's btDbvt, rebuilt from the top after the insertions",
                             "build = insert each box + optimizeTopDown(32)", true)};
    for (ContenderEntry& e : bullet_kernels())
        peer.contenders.push_back(std::move(e));
    return peer;
}

} // namespace boxwood::bench
