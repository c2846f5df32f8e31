#include "bench/peers/answering.h"
#include "bench/peers/embree_handles.h"
#include "bench/peers/ray_peers.h"
#include "bench/tasks/detail/ray_classes.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <span>

namespace boxwood::bench {
namespace {

template <int W> struct PacketTypes;
template <> struct PacketTypes<8> {
    using Rays = RTCRay8;
    using RayHits = RTCRayHit8;
    static constexpr auto intersect = rtcIntersect8;
    static constexpr auto occluded = rtcOccluded8;
};
template <> struct PacketTypes<16> {
    using Rays = RTCRay16;
    using RayHits = RTCRayHit16;
    static constexpr auto intersect = rtcIntersect16;
    static constexpr auto occluded = rtcOccluded16;
};

/// A context whose filter collects what the ray meets; the context is the first member, so that the
/// filter can find the rest.
struct Collecting {
    RTCIntersectContext context;
    std::uint32_t ray;
    std::vector<Pair>* out;
};
static_assert(std::is_standard_layout_v<Collecting>);

/// Takes the hit down and refuses it, so that the ray goes on.
void collect(const RTCFilterFunctionNArguments* args) {
    Collecting& c = *reinterpret_cast<Collecting*>(args->context);
    if (args->valid[0] == -1)
        c.out->push_back({c.ray, RTCHitN_primID(args->hit, args->N, 0)});
    args->valid[0] = 0;
}

/// What is wanted of each ray.
enum class Wanted { closest, any, all };

constexpr int stream = 0; ///< a width: as many as there are in a chunk
constexpr std::size_t chunk = 256;

struct Setting {
    Wanted wanted = Wanted::closest;
    int width = 1;
    bool robust = false, coherent = false;
    RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
};

/// Rays `width` at a time, in Embree's own form, which is made in the constructor and copied for
/// each query: Embree writes what it finds into it.
class Rays final : public Contender {
  public:
    Rays(const Job& job, const Setting& setting)
        : scene_(*job.scene), setting_(setting), wanted_(setting.wanted), width_(setting.width),
          threads_(job.threads), vertices_(scene_.mesh.vertices), device_(make_device(job.threads)),
          arena_(static_cast<int>(job.threads)) {
        vertices_.emplace_back(); // Embree reads 16 bytes at the last vertex
        if (width_ == 8)
            fill(packets8_);
        else if (width_ == 16)
            fill(packets16_);
        else if (wanted_ == Wanted::any)
            std::ranges::transform(scene_.rays, std::back_inserter(occluding_), converted);
        else
            std::ranges::transform(scene_.rays, std::back_inserter(hitting_), hit_by);
    }

    void build() override {
        arena_.execute([&] {
            Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
            rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                       vertices_.data(), 0, sizeof(Vec3<float>),
                                       vertices_.size() - 1);
            rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                       scene_.mesh.triangles.data(), 0,
                                       sizeof(scene_.mesh.triangles[0]),
                                       scene_.mesh.triangles.size());
            if (wanted_ == Wanted::all)
                rtcSetGeometryIntersectFilterFunction(geometry.get(), collect);
            embree_scene_ = commit(device_.get(), std::move(geometry), setting_.quality,
                                   setting_.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
        });
    }

    void query(Answers& answers) override {
        if (wanted_ == Wanted::all)
            return find_all(list_of<Pair>(answers));
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(scene_.rays.size());
        for_chunks([&](std::size_t begin, std::size_t end) {
            const FlushDenormals flush;
            if (width_ == 8)
                return cast<8>(packets8_, begin, end, hits);
            if (width_ == 16)
                return cast<16>(packets16_, begin, end, hits);
            if (width_ == stream)
                return wanted_ == Wanted::any ? occluded_stream(begin, end, hits)
                                              : closest_stream(begin, end, hits);
            for (std::size_t i = begin; i < end; ++i)
                hits[i] = wanted_ == Wanted::any ? occluded(occluding_[i])
                                                 : closest(embree_scene_.get(), hitting_[i]);
        });
    }

  private:
    template <int W> using PacketOf = typename PacketTypes<W>::RayHits;

    /// The last packet has fewer rays than lanes: the last ray again.
    template <class Packet> void fill(std::vector<Packet>& packets) const {
        const std::span<const Ray<float>> rays = scene_.rays;
        const auto width = static_cast<std::size_t>(width_);
        for (std::size_t first = 0; first < rays.size(); first += width) {
            Packet& packet = packets.emplace_back();
            for (std::size_t k = 0; k < width; ++k) {
                const Ray<float>& ray = rays[std::min(first + k, rays.size() - 1)];
                packet.ray.org_x[k] = ray.origin.x;
                packet.ray.org_y[k] = ray.origin.y;
                packet.ray.org_z[k] = ray.origin.z;
                packet.ray.dir_x[k] = ray.direction.x;
                packet.ray.dir_y[k] = ray.direction.y;
                packet.ray.dir_z[k] = ray.direction.z;
                packet.ray.tnear[k] = ray.t_min;
                packet.ray.tfar[k] = ray.t_max;
                packet.ray.time[k] = 0;
                packet.ray.mask[k] = ~0u;
                packet.ray.id[k] = packet.ray.flags[k] = 0;
                packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            }
        }
    }

    /// work(begin, end) on the threads of the job: rays, in whole packets.
    template <class Work> void for_chunks(const Work& work) {
        const std::size_t n = scene_.rays.size();
        if (threads_ == 1 && width_ != stream)
            return work(0, n);
        if (threads_ == 1) {
            for (std::size_t begin = 0; begin < n; begin += chunk)
                work(begin, std::min(n, begin + chunk));
            return;
        }
        arena_.execute([&] {
            tbb::parallel_for(std::size_t{0}, (n + chunk - 1) / chunk, [&](std::size_t i) {
                work(i * chunk, std::min(n, (i + 1) * chunk));
            });
        });
    }

    void find_all(std::vector<Pair>& pairs) {
        pairs.clear();
        for (std::vector<Pair>& part : parts_)
            part.clear();
        for_chunks([&](std::size_t begin, std::size_t end) {
            const FlushDenormals flush;
            all(begin, end, threads_ == 1 ? pairs : parts_.local());
        });
        for (const std::vector<Pair>& part : parts_)
            pairs.insert(pairs.end(), part.begin(), part.end());
    }

    /// A hit has some triangle number; Embree does not say which triangle it was.
    RayHit occluded(RTCRay query) const {
        RTCIntersectContext with = context();
        rtcOccluded1(embree_scene_.get(), &with, &query);
        return occlusion_of(query);
    }
    static RayHit occlusion_of(const RTCRay& query) {
        RayHit hit;
        if (query.tfar < 0) // -inf marks a hit
            hit.triangle = 0;
        return hit;
    }

    RTCIntersectContext context() const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = setting_.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                          : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        return context;
    }

    void closest_stream(std::size_t begin, std::size_t end, std::vector<RayHit>& hits) const {
        std::array<RTCRayHit, chunk> queries;
        std::copy(hitting_.begin() + static_cast<std::ptrdiff_t>(begin),
                  hitting_.begin() + static_cast<std::ptrdiff_t>(end), queries.begin());
        RTCIntersectContext with = context();
        rtcIntersect1M(embree_scene_.get(), &with, queries.data(),
                       static_cast<unsigned>(end - begin), sizeof(RTCRayHit));
        for (std::size_t i = begin; i < end; ++i)
            hits[i] = hit_of(queries[i - begin]);
    }
    void occluded_stream(std::size_t begin, std::size_t end, std::vector<RayHit>& hits) const {
        std::array<RTCRay, chunk> queries;
        std::copy(occluding_.begin() + static_cast<std::ptrdiff_t>(begin),
                  occluding_.begin() + static_cast<std::ptrdiff_t>(end), queries.begin());
        RTCIntersectContext with = context();
        rtcOccluded1M(embree_scene_.get(), &with, queries.data(),
                      static_cast<unsigned>(end - begin), sizeof(RTCRay));
        for (std::size_t i = begin; i < end; ++i)
            hits[i] = occlusion_of(queries[i - begin]);
    }

    void all(std::size_t begin, std::size_t end, std::vector<Pair>& out) const {
        Collecting collecting{};
        collecting.out = &out;
        for (std::size_t i = begin; i < end; ++i) {
            rtcInitIntersectContext(&collecting.context);
            collecting.ray = static_cast<std::uint32_t>(i);
            RTCRayHit query = hitting_[i];
            rtcIntersect1(embree_scene_.get(), &collecting.context, &query);
        }
    }

    template <int W>
    void cast(const std::vector<PacketOf<W>>& packets, std::size_t begin, std::size_t end,
              std::vector<RayHit>& hits) const {
        using Types = PacketTypes<W>;
        for (std::size_t first = begin; first < end; first += W) {
            alignas(64) PacketOf<W> packet = packets[first / W];
            const std::size_t n = std::min<std::size_t>(W, end - first);
            alignas(64) int valid[W];
            for (std::size_t k = 0; k < W; ++k)
                valid[k] = k < n ? -1 : 0;
            RTCIntersectContext with = context();
            if (wanted_ == Wanted::any) {
                Types::occluded(valid, embree_scene_.get(), &with,
                                reinterpret_cast<typename Types::Rays*>(&packet.ray));
                for (std::size_t k = 0; k < n; ++k) {
                    hits[first + k] = {};
                    if (packet.ray.tfar[k] < 0)
                        hits[first + k].triangle = 0;
                }
                continue;
            }
            Types::intersect(valid, embree_scene_.get(), &with, &packet);
            for (std::size_t k = 0; k < n; ++k)
                hits[first + k] = packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID
                                      ? RayHit{}
                                      : RayHit{packet.ray.tfar[k], packet.hit.u[k], packet.hit.v[k],
                                               packet.hit.primID[k]};
        }
    }

    const Scene& scene_;
    Setting setting_;
    Wanted wanted_;
    int width_;
    unsigned threads_;
    std::vector<Vec3<float>> vertices_;
    // The rays in the form of one of these:
    std::vector<RTCRay> occluding_;
    std::vector<RTCRayHit> hitting_;
    std::vector<RTCRayHit8> packets8_;
    std::vector<RTCRayHit16> packets16_;
    Device device_;
    tbb::task_arena arena_;
    SceneHandle embree_scene_;
    tbb::enumerable_thread_specific<std::vector<Pair>> parts_; ///< of rays_all
};

std::string_view quality_name(RTCBuildQuality quality) {
    return quality == RTC_BUILD_QUALITY_LOW    ? "low"
           : quality == RTC_BUILD_QUALITY_HIGH ? "high"
                                               : "medium";
}

std::string calls_of(const Setting& s) {
    if (s.wanted == Wanted::all)
        return "single rays, whose intersection filter takes each hit down and refuses it";
    if (s.width == 1)
        return "single rays";
    if (s.width == stream)
        return fmt::format("streams of {} rays", chunk);
    return fmt::format("packets of {} rays", s.width);
}

ContenderEntry rays(const Setting& s) {
    const std::string width = s.width == stream ? "1M" : std::to_string(s.width);
    const bool is_medium = s.quality == RTC_BUILD_QUALITY_MEDIUM;
    ContenderEntry e;
    e.name = fmt::format(
        "embree.rtc_{}{}{}{}{}{}", s.wanted == Wanted::any ? "occluded" : "intersect",
        s.width == stream ? "1m" : width, s.wanted == Wanted::all ? ".filter" : "",
        s.robust ? ".robust" : "", is_medium ? "" : fmt::format(".{}", quality_name(s.quality)),
        s.coherent ? ".coherent" : "");
    e.library = "embree";
    e.precision = "f32";
    e.summary =
        fmt::format("Embree's rtc{}{} on triangles, {}, build quality {}",
                    s.wanted == Wanted::any ? "Occluded" : "Intersect", width,
                    s.robust ? "ROBUST scene (watertight)" : "default scene (not watertight)",
                    quality_name(s.quality));
    e.notes = fmt::format(
        "{}, in the order given, context flag {}; the rays in Embree's structs, made before and "
        "copied in the query, as Embree writes into them; denormals flushed during the query, as "
        "Embree wants; vertex and index buffers shared; a build also frees the scene before it",
        calls_of(s), s.coherent ? "COHERENT" : "INCOHERENT");
    e.runs_on = RunsOn::tbb;
    e.cannot = [](const Job& job) -> std::optional<std::string> {
        if (std::holds_alternative<RayCases>(job.scene->cases))
            return "answers about the rays of a scene, not about cases";
        return std::nullopt;
    };
    e.classes = {ray_class::batches};
    if (s.wanted != Wanted::all)
        e.classes = s.width == 1 ? std::vector{ray_class::single, ray_class::batches}
                                 : std::vector{ray_class::packets};
    if (s.robust)
        e.classes = ray_class::watertight(std::move(e.classes));
    e.answers = {answering<Rays>(s.wanted == Wanted::closest ? "rays_closest"
                                 : s.wanted == Wanted::any   ? "rays_any"
                                                             : "rays_all",
                                 s)};
    return e;
}

} // namespace

std::vector<ContenderEntry> embree_rays() {
    std::vector<ContenderEntry> all;
    for (const Wanted wanted : {Wanted::closest, Wanted::any, Wanted::all})
        for (const RTCBuildQuality quality :
             {RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH, RTC_BUILD_QUALITY_LOW})
            for (const bool coherent : {false, true})
                for (const int width : {1, 8, 16, stream})
                    for (const bool robust : {false, true})
                        // What a single ray is told of coherence Embree does not look at; in a
                        // scene of HIGH, which splits triangles, a filter meets some twice.
                        if (width == 1 ? !coherent && !(wanted == Wanted::all &&
                                                        quality == RTC_BUILD_QUALITY_HIGH)
                                       : wanted != Wanted::all)
                            all.push_back(rays({wanted, width, robust, coherent, quality}));
    return all;
}

} // namespace boxwood::bench
