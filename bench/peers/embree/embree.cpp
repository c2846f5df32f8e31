#include "bench/peers/answering.h"
#include "bench/peers/comers.h"
#include "bench/peers/embree/embree_handles.h"
#include "bench/peers/kernel_peers.h"
#include "bench/peers/point_peers.h"
#include "bench/peers/ray_peers.h"
#include "bench/peers/tree_peers.h"
#include "scenes/moving/frames.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <array>
#include <cstdint>

namespace boxwood::bench {
namespace {

/// Embree leaves out what has no valid bounds: bodies that are not present have empty boxes.
void bounds_of_box(const RTCBoundsFunctionArguments* args) {
    const Aabb<float>& box = static_cast<const Aabb<float>*>(args->geometryUserPtr)[args->primID];
    *args->bounds_o = {box.min.x, box.min.y, box.min.z, 0, box.max.x, box.max.y, box.max.z, 0};
}

class Collide final : public Contender {
  public:
    Collide(const Job& job, Sides sides, RTCBuildQuality quality)
        : scene_(*job.scene), boxes_(scene_.boxes), quality_(quality),
          split_(sides == Sides::two_halves ? tree_pairs_split(boxes_.size()) : 0),
          between_halves_(sides == Sides::two_halves), threads_(job.threads),
          device_(make_device(job)), arena_(static_cast<int>(job.threads)) {}

    void build() override {
        boxes_ = scene_.boxes;
        arena_.execute([&] {
            first_.reset();
            rest_.reset();
            first_ = make_scene_of(0, split_);
            rest_ = make_scene_of(split_, boxes_.size());
        });
    }

    /// The same geometry with its new bounds, committed again: a rebuild, or where the quality is
    /// `refit` new bounds for the nodes that are there.
    void update(const Frame& frame) override {
        boxes_ = frame.boxes;
        if (!rest_)
            return;
        arena_.execute([&] {
            const RTCGeometry geometry = rtcGetGeometry(rest_.get(), 0);
            rtcSetGeometryUserData(geometry, const_cast<Aabb<float>*>(boxes_.data()));
            rtcCommitGeometry(geometry);
            rtcCommitScene(rest_.get());
        });
        throw_if_failed(device_.get(), "updating the scene");
    }

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        if (!rest_ || (between_halves_ && !first_))
            return;
        out_ = threads_ == 1 ? &pairs : nullptr;
        for (std::vector<Pair>& part : parts_)
            part.clear();
        arena_.execute([&] {
            rtcCollide(between_halves_ ? first_.get() : rest_.get(), rest_.get(), take, this);
        });
        throw_if_failed(device_.get(), "rtcCollide");
        for (const std::vector<Pair>& part : parts_)
            pairs.insert(pairs.end(), part.begin(), part.end());
    }

  private:
    SceneHandle make_scene_of(std::size_t begin, std::size_t end) const {
        if (begin == end)
            return nullptr;
        Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
        rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(end - begin));
        rtcSetGeometryUserData(geometry.get(), const_cast<Aabb<float>*>(boxes_.data() + begin));
        rtcSetGeometryBoundsFunction(geometry.get(), bounds_of_box, nullptr);
        return commit(device_.get(), std::move(geometry), quality_,
                      quality_ == RTC_BUILD_QUALITY_REFIT ? RTC_SCENE_FLAG_DYNAMIC
                                                          : RTC_SCENE_FLAG_NONE);
    }

    /// Embree hands over candidates from its leaves: those of one scene in both orders, and some
    /// whose boxes do not overlap. Called by several threads at a time if there are several.
    static void take(void* self, RTCCollision* candidates, unsigned n) {
        const Collide& c = *static_cast<const Collide*>(self);
        std::vector<Pair>& out = c.out_ ? *c.out_ : c.parts_.local();
        for (unsigned k = 0; k < n; ++k) {
            const Pair pair{static_cast<std::uint32_t>(candidates[k].primID0),
                            static_cast<std::uint32_t>(candidates[k].primID1 + c.split_)};
            if (pair.a < pair.b && overlaps(c.boxes_[pair.a], c.boxes_[pair.b]))
                out.push_back(pair);
        }
    }

    const Scene& scene_;
    std::span<const Aabb<float>> boxes_; ///< of the scene, or of its newest frame
    RTCBuildQuality quality_;
    std::size_t split_;
    bool between_halves_;
    unsigned threads_;
    Device device_;
    tbb::task_arena arena_;
    SceneHandle first_, rest_; ///< all boxes in `rest_` but for two halves; null if empty
    std::vector<Pair>* out_ = nullptr;
    mutable tbb::enumerable_thread_specific<std::vector<Pair>> parts_;
};

ContenderEntry entry(std::string name, std::string summary, std::string notes) {
    ContenderEntry e;
    e.name = "embree." + std::move(name);
    e.library = "embree";
    e.summary = std::move(summary);
    e.notes = std::move(notes);
    e.precision = "f32";
    return e;
}

ContenderEntry collide(RTCBuildQuality quality) {
    const char* const word = word_of(quality);
    ContenderEntry e =
        entry(fmt::format("rtc_collide.{}", word),
              fmt::format("Embree's rtcCollide on user geometry, build quality {}", word),
              "rtcCollide gives candidates, within one scene in both orders: the callback keeps i "
              "< j and "
              "tests the two boxes; with several threads pairs go to one list per thread that are "
              "joined at "
              "the end; build = one geometry with its bounds callback, attached and committed; "
              "boxes beyond "
              "1.8e18 are dropped by Embree; a build also frees the scene before it");
    const bool refit = quality == RTC_BUILD_QUALITY_REFIT;
    e.notes +=
        refit ? "; a dynamic scene of quality low, as a refit wants, whose nodes are fitted again "
                "in each frame"
              : "; a frame: the geometry committed again and the scene rebuilt";
    e.runs_on = RunsOn::tbb;
    if (!refit) {
        e.answers = answering_all_pairs<Collide>(quality);
        return e;
    }
    e.answers = {answering<Collide>("moving_pairs", Sides::all, quality)};
    e.cannot = [](const Job& job) -> std::optional<std::string> {
        if (has_comers(job))
            return "a refit cannot take in bodies that were not there when the scene was built";
        return std::nullopt;
    };
    return e;
}

} // namespace

Peer embree_peer() {
    Peer peer;
    peer.name = "embree";
    peer.title = "Embree";
    peer.summary = "Intel Embree: ray tracing kernels, and collision of user geometry";
    peer.version = RTC_VERSION_STRING;
#if defined(BOXWOOD_EMBREE_4)
    peer.build = "of the prefix BOXWOOD_EMBREE: SIMD chosen at run time, TBB";
#else
    peer.build = "the distribution's package: SSE2 to AVX-512 chosen at run time, TBB";
#endif
    for (const RTCBuildQuality quality : build_qualities)
        peer.contenders.push_back(collide(quality));
    peer.contenders.push_back(collide(RTC_BUILD_QUALITY_REFIT));
    for (ContenderEntry& e : embree_rays())
        peer.contenders.push_back(std::move(e));
    for (ContenderEntry& e : embree_trees())
        peer.contenders.push_back(std::move(e));
    for (ContenderEntry& e : embree_points())
        peer.contenders.push_back(std::move(e));
    for (ContenderEntry& e : embree_kernels())
        peer.contenders.push_back(std::move(e));
    return peer;
}

} // namespace boxwood::bench
