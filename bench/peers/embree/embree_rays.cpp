/// Rays one at a time, and every hit; what all of Embree's contenders of rays have in common.

#include "bench/peers/embree/embree_rays.h"
#include "bench/peers/ray_peers.h"
#include "bench/tasks/detail/ray_classes.h"
#include "scenes/sampling/rays.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <iterator>
#include <type_traits>

namespace boxwood::bench {
namespace {

/// The context is the first member, so that the filter can find the rest.
struct Collecting {
    QueryContext context;
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

/// A triangle that the build has cut is met once in each part. Returns the new size.
std::size_t drop_repeated(std::vector<Pair>& pairs, std::size_t begin) {
    const auto own = std::span(pairs).subspan(begin);
    std::ranges::sort(own);
    pairs.resize(pairs.size() - std::ranges::unique(own).size());
    return pairs.size();
}

class SingleRays final : public EmbreeRays {
  public:
    SingleRays(const Job& job, const RaySettings& settings) : EmbreeRays(job, settings) {
        std::ranges::transform(scene_.rays, std::back_inserter(rays_), converted);
    }

    void query(Answers& answers) override {
        if (settings_.wanted == Wanted::all)
            return find_all(list_of<Pair>(answers));
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(rays_.size());
        for_chunks(rays_.size(), chunk, [&](std::size_t begin, std::size_t end) {
            QueryContext context;
            Tracing tracing(embree_scene(), false, context);
            if (settings_.wanted == Wanted::any)
                trace_any(tracing, begin, end, [&](std::size_t i, const RTCRay& answered) {
                    hits[i] = any_hit_by(answered.tfar);
                });
            else
                trace(tracing, begin, end, [&](std::size_t i, const RTCRayHit& answered) {
                    hits[i] = hit_in(answered);
                });
        });
    }

  private:
    /// Calls answered(i, what Embree wrote) for ray after ray.
    template <class Answered>
    void trace(Tracing& tracing, std::size_t begin, std::size_t end, const Answered& answered) {
        RTCRayHit query{};
        for (std::size_t i = begin; i < end; ++i) {
            query.ray = rays_[i];
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            tracing.intersect(query);
            answered(i, query);
        }
    }

    template <class Answered>
    void trace_any(Tracing& tracing, std::size_t begin, std::size_t end, const Answered& answered) {
        for (std::size_t i = begin; i < end; ++i) {
            RTCRay ray = rays_[i];
            tracing.occluded(ray);
            answered(i, ray);
        }
    }

    void find_all(std::vector<Pair>& pairs) {
        pairs.clear();
        for (std::vector<Pair>& part : parts_)
            part.clear();
        for_chunks(rays_.size(), chunk, [&](std::size_t begin, std::size_t end) {
            Collecting collecting{};
            collecting.out = threads_ == 1 ? &pairs : &parts_.local();
            Tracing tracing(embree_scene(), false, collecting.context);
            collecting.ray = static_cast<std::uint32_t>(begin);
            auto own = collecting.out->size();
            const auto answered = [&](std::size_t, const auto&) {
                if (settings_.quality == RTC_BUILD_QUALITY_HIGH)
                    own = drop_repeated(*collecting.out, own);
                ++collecting.ray;
            };
            if (settings_.in_no_order)
                trace_any(tracing, begin, end, answered);
            else
                trace(tracing, begin, end, answered);
        });
        for (const std::vector<Pair>& part : parts_)
            pairs.insert(pairs.end(), part.begin(), part.end());
    }

    std::vector<RTCRay> rays_;
    tbb::enumerable_thread_specific<std::vector<Pair>> parts_; ///< of rays_all
};

void append_single_rays(std::vector<ContenderEntry>& all, Wanted wanted, const char* task,
                        bool in_no_order = false) {
    RayForm form{"1", "1", "single rays", {ray_class::single, ray_class::batches}};
    if (wanted == Wanted::all)
        form = {"1",
                "1.filter",
                "single rays, whose filter takes each hit down and refuses it",
                {ray_class::batches}};
    for (const RTCBuildQuality quality : build_qualities)
        for (const bool is_robust : {false, true}) {
            const RaySettings settings{.wanted = wanted,
                                       .quality = quality,
                                       .is_robust = is_robust,
                                       .in_no_order = in_no_order};
            ContenderEntry e = ray_entry(form, settings);
            if (wanted == Wanted::all && quality == RTC_BUILD_QUALITY_HIGH)
                e.notes += "; cut triangles are met several times: each ray's are sorted, and "
                           "those that repeat dropped";
            e.answers = {answering<SingleRays>(task, settings)};
            all.push_back(std::move(e));
        }
}

} // namespace

EmbreeRays::EmbreeRays(const Job& job, const RaySettings& settings)
    : scene_(*job.scene), settings_(settings), threads_(job.threads),
      vertices_(scene_.mesh.vertices), device_(make_device(job)),
      arena_(static_cast<int>(job.threads)) {
    vertices_.emplace_back(); // Embree reads 16 bytes at the last vertex
}

void EmbreeRays::build() {
    arena_.execute([&] {
        embree_scene_.reset();
        Geometry geometry = triangle_geometry(device_.get(), vertices_, scene_.mesh);
        if (settings_.wanted == Wanted::all)
            (settings_.in_no_order
                 ? rtcSetGeometryOccludedFilterFunction
                 : rtcSetGeometryIntersectFilterFunction)(geometry.get(), collect);
        embree_scene_ = commit(device_.get(), std::move(geometry), settings_.quality,
                               settings_.is_robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    });
}

std::vector<std::uint32_t> EmbreeRays::lanes(std::size_t width) const {
    const std::size_t n = scene_.rays.size();
    return settings_.in_tiles ? lanes_in_tiles(n, picture_width(scene_.spec.rays, n), width)
                              : lanes_in_order(n, width);
}

ContenderEntry ray_entry(const RayForm& form, const RaySettings& settings) {
    const bool any = settings.wanted == Wanted::any || settings.in_no_order;
    ContenderEntry e;
    e.name = fmt::format("embree.rtc_{}{}", any ? "occluded" : "intersect", form.word);
    if (settings.is_robust)
        e.name += ".robust";
    if (settings.quality != RTC_BUILD_QUALITY_MEDIUM)
        e.name += fmt::format(".{}", word_of(settings.quality));
    if (settings.is_coherent)
        e.name += ".coherent";
    if (settings.in_tiles)
        e.name += ".tiles";
    e.library = "embree";
    e.precision = "f32";
    e.summary = fmt::format(
        "Embree's rtc{}{} on triangles, {}", any ? "Occluded" : "Intersect", form.function,
        settings.is_robust ? "ROBUST scene (watertight)" : "default scene (not watertight)");
    e.notes = fmt::format(
        "{}, {}context flag {}, build quality {}; the rays in Embree's structs, made before and "
        "copied in the query, as Embree writes into them; what it wrote is read into the answers; "
        "denormals flushed during the query, as Embree wants; vertex and index buffers shared; a "
        "build also frees the scene before it",
        form.notes,
        settings.in_tiles ? "filled by tiles of the picture, answers put back in the query, " : "",
        settings.is_coherent ? "COHERENT" : "INCOHERENT", word_of(settings.quality));
    e.runs_on = RunsOn::tbb;
    e.classes = settings.is_robust ? ray_class::watertight(form.classes) : form.classes;
    e.cannot = [in_tiles = settings.in_tiles](const Job& job) -> std::optional<std::string> {
        if (std::holds_alternative<RayCases>(job.scene->cases))
            return "answers about the rays of a scene, not about cases";
        if (in_tiles && picture_width(job.scene->spec.rays, job.scene->rays.size()) == 0)
            return "fills its lanes by tiles of a picture, which these rays are not";
        return std::nullopt;
    };
    return e;
}

std::vector<ContenderEntry> embree_rays() {
    std::vector<ContenderEntry> all;
    append_single_rays(all, Wanted::closest, "rays_closest");
    append_single_rays(all, Wanted::any, "rays_any");
    append_single_rays(all, Wanted::all, "rays_all");
    append_single_rays(all, Wanted::all, "rays_all", true);
    append_embree_packets(all);
    append_embree_streams(all);
    return all;
}

} // namespace boxwood::bench
