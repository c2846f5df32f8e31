#include "bench/peers/answering.h"
#include "bench/peers/bullet/bullet_volume.h"
#include "bench/tasks/moving_pairs.h"
#include "scenes/moving/frames.h"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <LinearMath/btAabbUtil2.h>
#include <fmt/format.h>

#include <utility>

namespace boxwood::bench {
namespace {

/// When pairs are looked for.
enum class Search : std::uint8_t {
    at_each_change, ///< a leaf that changes is taken through both trees
    once_a_frame    ///< the trees are taken through each other (m_deferedcollide)
};

struct Settings {
    Search search;
    float margin; ///< of leaves that move, in mean sides
};

class Broadphase final : public Contender {
  public:
    Broadphase(const Job& job, Settings settings)
        : scene_(*job.scene), settings_(settings), margin_before_(gDbvtMargin),
          proxies_(scene_.boxes.size()) {}
    Broadphase(const Broadphase&) = delete;
    Broadphase& operator=(const Broadphase&) = delete;
    ~Broadphase() override {
        free();
        gDbvtMargin = margin_before_;
    }

    void build() override {
        free();
        cache_ = std::make_unique<btHashedOverlappingPairCache>();
        broadphase_ = std::make_unique<btDbvtBroadphase>(cache_.get());
        broadphase_->m_deferedcollide = settings_.search == Search::once_a_frame;
        gDbvtMargin = settings_.margin * mean_side(scene_.boxes);
        for (std::size_t i = 0; i < proxies_.size(); ++i)
            if (!scene_.boxes[i].is_empty())
                create(i, scene_.boxes[i]);
        broadphase_->calculateOverlappingPairs(nullptr);
    }

    void update(const Frame& now) override {
        for (const std::uint32_t i : now.moved) {
            const Aabb<float>& box = now.boxes[i];
            if (box.is_empty())
                broadphase_->destroyProxy(std::exchange(proxies_[i], nullptr), nullptr);
            else if (!proxies_[i])
                create(i, box);
            else
                broadphase_->setAabb(proxies_[i], vector_of(box.min), vector_of(box.max), nullptr);
        }
        broadphase_->calculateOverlappingPairs(nullptr);
    }

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        const btBroadphasePairArray& cached = cache_->getOverlappingPairArray();
        for (int i = 0; i < cached.size(); ++i) {
            const btBroadphaseProxy &a = *cached[i].m_pProxy0, &b = *cached[i].m_pProxy1;
            if (TestAabbAgainstAabb2(a.m_aabbMin, a.m_aabbMax, b.m_aabbMin, b.m_aabbMax))
                pairs.push_back(ordered_pair(item_of_proxy(a), item_of_proxy(b)));
        }
    }

  private:
    static std::uint32_t item_of_proxy(const btBroadphaseProxy& proxy) {
        return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(proxy.m_clientObject));
    }

    void create(std::size_t i, const Aabb<float>& box) {
        proxies_[i] = broadphase_->createProxy(
            vector_of(box.min), vector_of(box.max), BOX_SHAPE_PROXYTYPE,
            reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)),
            btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter, nullptr);
    }

    /// Without the cache, which each destroyProxy would search through.
    void free() {
        if (!broadphase_)
            return;
        btNullPairCache none;
        broadphase_->m_paircache = &none;
        for (btBroadphaseProxy*& proxy : proxies_)
            if (proxy)
                broadphase_->destroyProxy(std::exchange(proxy, nullptr), nullptr);
        broadphase_.reset();
        cache_.reset();
    }

    const Scene& scene_;
    Settings settings_;
    btScalar margin_before_;                  ///< of the library, which has one for all
    std::vector<btBroadphaseProxy*> proxies_; ///< by item; null if it is not present
    std::unique_ptr<btHashedOverlappingPairCache> cache_;
    std::unique_ptr<btDbvtBroadphase> broadphase_;
};

ContenderEntry entry(std::string name, const std::string& search, Settings settings) {
    ContenderEntry e;
    e.name = std::move(name);
    e.library = "bullet";
    e.summary = "Bullet's btDbvtBroadphase with its cache of pairs, " + search;
    e.notes = fmt::format(
        "a frame: setAabb of each moved body, createProxy and destroyProxy of those that come and "
        "go, calculateOverlappingPairs; {}; leaves that move have a margin of {:g} of the mean "
        "side; query = the pairs of btHashedOverlappingPairCache whose boxes overlap; no velocity "
        "prediction, which is Bullet's default; one thread",
        search, settings.margin);
    e.precision = "f32";
    e.answers_from_cache = true;
    e.classes = {cached_pairs_class};
    e.runs_on = RunsOn::one_thread;
    e.answers = {answering<Broadphase>("moving_pairs", settings)};
    return e;
}

} // namespace

/// Of margins from 0 to half a mean side, at 1,000 bodies (update and query, interleaved minima on
/// a shared machine): at each change a tenth was best in a crowd (85 us; 0: 270, a half: 143), once
/// a frame a twentieth (97 us; 0: 182), and in a free fall, where all moves far, 388 us (at each
/// change 581). Prediction by a quarter of a half side was between 5 % better and 13 % worse, and
/// m_cupdates = 100 instead of 10 8 % better to 10 % worse.
std::vector<ContenderEntry> bullet_broadphases() {
    return {
        entry("bullet.dbvt_broadphase", "looked for at each change", {Search::at_each_change, .1f}),
        entry("bullet.dbvt_broadphase.deferred", "looked for once a frame (m_deferedcollide)",
              {Search::once_a_frame, .05f})};
}

} // namespace boxwood::bench
