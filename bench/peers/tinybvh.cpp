#define TINYBVH_IMPLEMENTATION
#define NO_THREADED_BUILDS // a build takes the one thread of its cell
#include <tiny_bvh.h>

#include "bench/peers/answering.h"
#include "bench/peers/ray_peers.h"
#include "bench/tasks/detail/ray_classes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boxwood::bench {
namespace {

/// What of a ray is wanted.
enum class Wanted : std::uint8_t { closest, any };
enum class Build : std::uint8_t { plain, spatial_splits };

/// The ray as tinybvh's constructor makes it, but for its direction, which keeps its length so that
/// t is ours.
tinybvh::Ray converted(const Ray<float>& ray) {
    tinybvh::Ray made;
    made.O = {ray.origin.x, ray.origin.y, ray.origin.z};
    made.D = {ray.direction.x, ray.direction.y, ray.direction.z};
    made.rD = tinybvh::tinybvh_rcp(made.D);
    made.hit.t = ray.t_max;
    return made;
}

template <class Layout> class SingleRays final : public Contender {
  public:
    SingleRays(const Job& job, Wanted wanted, Build build)
        : scene_(*job.scene), wanted_(wanted), build_(build) {
        for (const Vec3<float> v : scene_.mesh.vertices)
            vertices_.emplace_back(v.x, v.y, v.z, 0.f);
        for (const auto& triangle : scene_.mesh.triangles)
            indices_.insert(indices_.end(), triangle.begin(), triangle.end());
        std::ranges::transform(scene_.rays, std::back_inserter(rays_), converted);
    }

    void build() override {
        layout_.reset();
        layout_ = std::make_unique<Layout>();
        const tinybvh::bvhvec4slice vertices(vertices_.data(),
                                             static_cast<std::uint32_t>(vertices_.size()));
        const auto n = static_cast<std::uint32_t>(scene_.mesh.triangles.size());
        if (build_ == Build::plain)
            layout_->Build(vertices, indices_.data(), n);
        else
            layout_->BuildHQ(vertices, indices_.data(), n);
    }

    void query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(rays_.size());
        for (std::size_t i = 0; i < rays_.size(); ++i) {
            tinybvh::Ray ray = rays_[i]; // tinybvh writes into it
            RayHit hit;
            if (wanted_ == Wanted::any) {
                if (layout_->IsOccluded(ray))
                    hit.triangle = 0;
            } else {
                layout_->Intersect(ray);
                if (ray.hit.t < scene_.rays[i].t_max)
                    hit = {ray.hit.t, ray.hit.u, ray.hit.v, ray.hit.prim};
            }
            hits[i] = hit;
        }
    }

  private:
    const Scene& scene_;
    Wanted wanted_;
    Build build_;
    std::vector<tinybvh::bvhvec4> vertices_;
    std::vector<std::uint32_t> indices_;
    std::vector<tinybvh::Ray> rays_;
    std::unique_ptr<Layout> layout_;
};

std::optional<std::string> cannot(const Job& job) {
    if (std::holds_alternative<RayCases>(job.scene->cases))
        return "answers about the rays of a scene, not about cases";
    if (auto why = missing_avx2())
        return why;
    if (job.scene->mesh.triangles.size() < 2)
        return "wants two triangles at least";
    if (std::ranges::any_of(job.scene->rays, [](const Ray<float>& ray) { return ray.t_min != 0; }))
        return "rays that begin at t_min > 0 are unknown to it";
    return std::nullopt;
}

template <class Layout>
void append(std::vector<ContenderEntry>& all, const std::string& name, const std::string& layout) {
    for (const Build build : {Build::plain, Build::spatial_splits}) {
        const bool is_plain = build == Build::plain;
        ContenderEntry e;
        e.name = "tinybvh." + name + (is_plain ? "" : ".hq");
        e.library = "tinybvh";
        e.summary = fmt::format("tinybvh's {}, {}", layout,
                                is_plain ? "binned SAH" : "spatial splits (BuildHQ)");
        e.notes = fmt::format("build = {} over indexed vertices, one thread; rays in tinybvh's "
                              "structs, made before and copied in the query, directions not "
                              "normalised; Moeller-Trumbore, which takes triangles for edge-on "
                              "below |det| = 1e-6; compiled for AVX2 and FMA",
                              is_plain ? "Build" : "BuildHQ");
        e.precision = "f32";
        e.runs_on = RunsOn::one_thread;
        e.classes = {ray_class::single, ray_class::batches};
        e.cannot = cannot;
        e.answers = {answering<SingleRays<Layout>>("rays_closest", Wanted::closest, build),
                     answering<SingleRays<Layout>>("rays_any", Wanted::any, build)};
        all.push_back(std::move(e));
    }
}

} // namespace

Peer tinybvh_peer() {
    Peer peer;
    peer.name = "tinybvh";
    peer.title = "tinybvh";
    peer.summary = "tinybvh: ray tracing by wide trees";
    peer.version = fmt::format("{}.{}.{}", TINY_BVH_VERSION_MAJOR, TINY_BVH_VERSION_MINOR,
                               TINY_BVH_VERSION_SUB);
    peer.build = "the user's header, compiled here for AVX2 and FMA";
    append<tinybvh::BVH8_CPU>(peer.contenders, "bvh8_cpu", "BVH8_CPU");
    append<tinybvh::BVH4_CPU>(peer.contenders, "bvh4_cpu", "BVH4_CPU");
    return peer;
}

} // namespace boxwood::bench
