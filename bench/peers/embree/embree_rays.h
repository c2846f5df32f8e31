#pragma once

#include "bench/peers/answering.h"
#include "bench/peers/embree/embree_handles.h"
#include "bench/peers/ray_lanes.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// What Embree's contenders of rays share.
namespace boxwood::bench {

/// What is wanted of each ray.
enum class Wanted : std::uint8_t { closest, any, all };

/// What Embree is told beside the rays.
struct RaySettings {
    Wanted wanted = Wanted::closest;
    RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
    bool in_tiles = false;    ///< lanes are filled tile by tile of the picture
    bool is_coherent = false; ///< by the flag, which Embree reads of packets and streams alone
    bool is_robust = false;   ///< by the flag of the scene: watertight
    bool in_no_order = false; ///< every hit by rtcOccluded, which need not go by distance
};

/// The mesh in Embree, and the threads that trace. Rays are in Embree's form from the constructor
/// on. A query copies them, as Embree writes into them, and reads what was written into the
/// answers: 16 bytes a ray, as ours write.
class EmbreeRays : public Contender {
  public:
    EmbreeRays(const Job& job, const RaySettings& settings);

    void build() override;

  protected:
    /// Rays of a thread at a time.
    static constexpr std::size_t chunk = 256;

    RTCScene embree_scene() const { return embree_scene_.get(); }

    /// work(begin, end) for all of 0 to n on the threads of the job, `step` at a time if there are
    /// several; denormals are flushed meanwhile.
    template <class Work> void for_chunks(std::size_t n, std::size_t step, const Work& work) {
        const auto flushed = [&](std::size_t begin, std::size_t end) {
            const FlushDenormals flush;
            work(begin, end);
        };
        if (threads_ == 1)
            return flushed(0, n);
        arena_.execute([&] {
            tbb::parallel_for(std::size_t{0}, (n + step - 1) / step, [&](std::size_t i) {
                flushed(i * step, std::min(n, (i + 1) * step));
            });
        });
    }

    std::vector<std::uint32_t> lanes(std::size_t width) const;
    /// For a lane without a ray some ray.
    const Ray<float>& ray_in(std::uint32_t lane) const {
        return scene_.rays[lane == no_ray ? 0 : lane];
    }

    const Scene& scene_;
    RaySettings settings_;
    unsigned threads_;

  private:
    std::vector<Vec3<float>> vertices_;
    Device device_;
    tbb::task_arena arena_;
    SceneHandle embree_scene_;
};

/// A way to hand rays to Embree.
struct RayForm {
    std::string_view function; ///< what rtcIntersect and rtcOccluded end in: "8", "1M"
    std::string_view word;     ///< in names of contenders: "8", "1m"
    std::string_view notes;
    std::vector<std::string> classes;
};

/// A row without what answers.
ContenderEntry ray_entry(const RayForm& form, const RaySettings& settings);

/// A row for each setting of a form that takes several rays, answered by a C(job, settings).
template <class C> void append_batches(std::vector<ContenderEntry>& all, const RayForm& form) {
    for (const Wanted wanted : {Wanted::closest, Wanted::any})
        for (const bool in_tiles : {false, true})
            for (const RTCBuildQuality quality : build_qualities)
                for (const bool is_coherent : {false, true})
                    for (const bool is_robust : {false, true}) {
                        const RaySettings settings{wanted, quality, in_tiles, is_coherent,
                                                   is_robust};
                        ContenderEntry e = ray_entry(form, settings);
                        e.answers = {answering<C>(
                            wanted == Wanted::closest ? "rays_closest" : "rays_any", settings)};
                        all.push_back(std::move(e));
                    }
}

void append_embree_packets(std::vector<ContenderEntry>& all);
/// Nothing of Embree 4, which has no streams.
void append_embree_streams(std::vector<ContenderEntry>& all);

} // namespace boxwood::bench
