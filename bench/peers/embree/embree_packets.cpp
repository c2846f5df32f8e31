#include "bench/peers/embree/embree_rays.h"
#include "bench/tasks/detail/ray_classes.h"

#include <array>
#include <type_traits>

namespace boxwood::bench {
namespace {

/// W rays in a call.
template <int W> class Packets final : public EmbreeRays {
    using Rays = std::conditional_t<W == 8, RTCRay8, RTCRay16>;
    using RayHits = std::conditional_t<W == 8, RTCRayHit8, RTCRayHit16>;

  public:
    Packets(const Job& job, const RaySettings& settings)
        : EmbreeRays(job, settings), lanes_(lanes(W)), packets_(lanes_.size() / W),
          valid_(packets_.size()) {
        for (std::size_t i = 0; i < lanes_.size(); ++i) {
            const Ray<float>& ray = ray_in(lanes_[i]);
            Rays& packet = packets_[i / W];
            const std::size_t k = i % W;
            packet.org_x[k] = ray.origin.x;
            packet.org_y[k] = ray.origin.y;
            packet.org_z[k] = ray.origin.z;
            packet.dir_x[k] = ray.direction.x;
            packet.dir_y[k] = ray.direction.y;
            packet.dir_z[k] = ray.direction.z;
            packet.tnear[k] = ray.t_min;
            packet.tfar[k] = ray.t_max;
            packet.time[k] = 0;
            packet.mask[k] = ~0u;
            packet.id[k] = packet.flags[k] = 0;
            valid_[i / W][k] = lanes_[i] == no_ray ? 0 : -1;
        }
    }

    void query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(scene_.rays.size());
        for_chunks(packets_.size(), chunk / W, [&](std::size_t begin, std::size_t end) {
            QueryContext context;
            Tracing tracing(embree_scene(), settings_.is_coherent, context);
            if (settings_.wanted == Wanted::any)
                find_any(tracing, begin, end, hits);
            else
                find_closest(tracing, begin, end, hits);
        });
    }

  private:
    /// -1 in the lanes that hold a ray.
    struct alignas(W * sizeof(int)) Valid : std::array<int, W> {};

    void find_any(Tracing& tracing, std::size_t begin, std::size_t end,
                  std::vector<RayHit>& hits) const {
        for (std::size_t p = begin; p < end; ++p) {
            const Valid& valid = valid_[p];
            Rays rays = packets_[p];
            tracing.occluded(valid.data(), rays);
            for (std::size_t k = 0; k < W; ++k)
                if (valid[k])
                    hits[lanes_[p * W + k]] = any_hit_by(rays.tfar[k]);
        }
    }

    void find_closest(Tracing& tracing, std::size_t begin, std::size_t end,
                      std::vector<RayHit>& hits) const {
        RayHits query{};
        for (std::size_t p = begin; p < end; ++p) {
            const Valid& valid = valid_[p];
            query.ray = packets_[p];
            std::ranges::fill(query.hit.geomID, RTC_INVALID_GEOMETRY_ID);
            tracing.intersect(valid.data(), query);
            for (std::size_t k = 0; k < W; ++k)
                if (valid[k])
                    hits[lanes_[p * W + k]] = query.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID
                                                  ? RayHit{}
                                                  : RayHit{query.ray.tfar[k], query.hit.u[k],
                                                           query.hit.v[k], query.hit.primID[k]};
        }
    }

    std::vector<std::uint32_t> lanes_;
    std::vector<Rays> packets_;
    std::vector<Valid> valid_; ///< by packet
};

} // namespace

void append_embree_packets(std::vector<ContenderEntry>& all) {
    append_batches<Packets<8>>(all, {"8", "8", "packets of 8 rays", {ray_class::batches}});
    append_batches<Packets<16>>(all, {"16", "16", "packets of 16 rays", {ray_class::batches}});
}

} // namespace boxwood::bench
