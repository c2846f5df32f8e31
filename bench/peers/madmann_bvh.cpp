#include "bench/peers/answering.h"
#include "bench/peers/ray_peers.h"
#include "bench/tasks/detail/ray_classes.h"

#include <bvh/v2/bvh.h>
#include <bvh/v2/default_builder.h>
#include <bvh/v2/node.h>
#include <bvh/v2/ray.h>
#include <bvh/v2/stack.h>
#include <bvh/v2/tri.h>
#include <bvh/v2/vec.h>

#include <fmt/format.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

using Node = bvh::v2::Node<float, 3>;
using Builder = bvh::v2::DefaultBuilder<Node>;
using Vector = bvh::v2::Vec<float, 3>;
using Bounds = bvh::v2::BBox<float, 3>;
using Prepared = bvh::v2::PrecomputedTri<float>;
using PeerRay = bvh::v2::Ray<float, 3>;

Vector vector(Vec3<float> v) { return {v.x, v.y, v.z}; }

/// How boxes are met: plainly, or padded as Ize has it.
enum class Boxes { fast, robust };

template <bool any, Boxes boxes> class SingleRays final : public Contender {
  public:
    SingleRays(const Job& job, Builder::Quality quality) : scene_(*job.scene) {
        config_.quality = quality;
        for (const auto& corners : scene_.mesh.triangles)
            triangles_.emplace_back(vector(scene_.mesh.vertices[corners[0]]),
                                    vector(scene_.mesh.vertices[corners[1]]),
                                    vector(scene_.mesh.vertices[corners[2]]));
        for (const Ray<float>& ray : scene_.rays)
            rays_.emplace_back(vector(ray.origin), vector(ray.direction), ray.t_min, ray.t_max);
    }

    void build() override {
        tree_ = {};
        prepared_.clear();
        std::vector<Bounds> bounds;
        std::vector<Vector> centres;
        bounds.reserve(triangles_.size());
        centres.reserve(triangles_.size());
        prepared_.reserve(triangles_.size());
        for (const auto& triangle : triangles_) {
            bounds.push_back(triangle.get_bbox());
            centres.push_back(triangle.get_center());
        }
        tree_ = Builder::build(bounds, centres, config_);
        for (const std::size_t i : tree_.prim_ids)
            prepared_.emplace_back(triangles_[i]);
    }

    void query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(rays_.size());
        bvh::v2::SmallStack<Node::Index, 128> stack;
        for (std::size_t i = 0; i < rays_.size(); ++i) {
            stack.size = 0;         // an any-hit leaves what it did not come to
            PeerRay ray = rays_[i]; // whose tmax comes nearer
            RayHit hit;
            const auto leaf = [&](std::size_t begin, std::size_t end) {
                for (std::size_t slot = begin; slot < end; ++slot)
                    if (const auto found = prepared_[slot].intersect(ray)) {
                        std::tie(hit.t, hit.u, hit.v) = *found;
                        hit.triangle = static_cast<std::uint32_t>(slot);
                        ray.tmax = hit.t;
                        if constexpr (any)
                            return true;
                    }
                return hit.hit();
            };
            tree_.template intersect<any, boxes == Boxes::robust>(ray, tree_.get_root().index,
                                                                  stack, leaf);
            if (hit.hit())
                hit.triangle = static_cast<std::uint32_t>(tree_.prim_ids[hit.triangle]);
            hits[i] = hit;
        }
    }

  private:
    const Scene& scene_;
    Builder::Config config_;
    std::vector<bvh::v2::Tri<float, 3>> triangles_;
    std::vector<PeerRay> rays_;
    bvh::v2::Bvh<Node> tree_;
    std::vector<Prepared> prepared_; ///< in the order of the leaves
};

std::optional<std::string> cannot(const Job& job) {
    if (std::holds_alternative<RayCases>(job.scene->cases))
        return "answers about the rays of a scene, not about cases";
    if (auto why = missing_avx2())
        return why;
    if (job.scene->mesh.triangles.empty())
        return "wants a triangle at least";
    return std::nullopt;
}

template <Boxes boxes>
void append(std::vector<ContenderEntry>& all, const std::string& name, Builder::Quality quality,
            const std::string& build) {
    const bool is_robust = boxes == Boxes::robust;
    ContenderEntry e;
    e.name = "madmann_bvh." + name + (is_robust ? ".robust" : "");
    e.library = "madmann_bvh";
    e.summary = fmt::format("madmann91/bvh, {}{}", build, is_robust ? ", padded boxes" : "");
    e.notes = fmt::format("build = DefaultBuilder, {}, one thread, and PrecomputedTri in the order "
                          "of the leaves; query = Bvh::intersect, {} boxes, one ray after another, "
                          "rays in its structs, made before; compiled for AVX2 and FMA",
                          build, is_robust ? "robust" : "fast");
    e.precision = "f32";
    e.runs_on = RunsOn::one_thread;
    e.classes = {ray_class::single, ray_class::batches};
    e.cannot = cannot;
    e.answers = {answering<SingleRays<false, boxes>>("rays_closest", quality),
                 answering<SingleRays<true, boxes>>("rays_any", quality)};
    all.push_back(std::move(e));
}

} // namespace

Peer madmann_bvh_peer() {
    Peer peer;
    peer.name = "madmann_bvh";
    peer.title = "madmann91/bvh";
    peer.summary = "madmann91/bvh: binary trees for rays";
    peer.version = "2";
    peer.build = "the user's headers, compiled here for AVX2 and FMA";
    using Quality = Builder::Quality;
    append<Boxes::fast>(peer.contenders, "low", Quality::Low, "binned SAH");
    append<Boxes::fast>(peer.contenders, "medium", Quality::Medium, "sweep SAH");
    append<Boxes::fast>(peer.contenders, "high", Quality::High, "sweep SAH and reinsertion");
    append<Boxes::robust>(peer.contenders, "high", Quality::High, "sweep SAH and reinsertion");
    return peer;
}

} // namespace boxwood::bench
