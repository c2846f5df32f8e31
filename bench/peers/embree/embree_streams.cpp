#include "bench/peers/embree/embree_rays.h"

#if defined(BOXWOOD_EMBREE_4)

namespace boxwood::bench {
void append_embree_streams(std::vector<ContenderEntry>&) {}
} // namespace boxwood::bench

#else

#include "bench/tasks/detail/ray_classes.h"

#include <array>
#include <limits>

namespace boxwood::bench {
namespace {

/// A stream is a chunk of rays. Lanes of tiles without a ray hold one that ends before it starts.
class Stream : public EmbreeRays {
  public:
    Stream(const Job& job, const RaySettings& settings)
        : EmbreeRays(job, settings), lanes_(lanes(16)) {}

    void query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(scene_.rays.size());
        for_chunks(lanes_.size(), chunk, [&](std::size_t begin, std::size_t end) {
            QueryContext context;
            Tracing tracing(embree_scene(), settings_.is_coherent, context);
            for (std::size_t first = begin; first < end; first += chunk) {
                const std::size_t n = std::min(chunk, end - first);
                if (settings_.wanted == Wanted::any)
                    find_any(tracing, first, n, hits);
                else
                    find_closest(tracing, first, n, hits);
            }
        });
    }

  protected:
    static constexpr float before_start = -std::numeric_limits<float>::infinity();

    /// Of the rays in n lanes.
    virtual void find_any(Tracing& tracing, std::size_t first, std::size_t n,
                          std::vector<RayHit>& hits) const = 0;
    virtual void find_closest(Tracing& tracing, std::size_t first, std::size_t n,
                              std::vector<RayHit>& hits) const = 0;

    /// hits[ray] = hit_of(k) for the rays in n lanes.
    template <class HitOf>
    void put(std::size_t first, std::size_t n, std::vector<RayHit>& hits,
             const HitOf& hit_of) const {
        for (std::size_t k = 0; k < n; ++k)
            if (const std::uint32_t ray = lanes_[first + k]; ray != no_ray)
                hits[ray] = hit_of(k);
    }

    std::vector<std::uint32_t> lanes_;
};

/// One struct after the other.
class Stream1M final : public Stream {
  public:
    Stream1M(const Job& job, const RaySettings& settings) : Stream(job, settings) {
        for (const std::uint32_t lane : lanes_) {
            rays_.push_back(converted(ray_in(lane)));
            if (lane == no_ray)
                rays_.back().tfar = before_start;
        }
    }

  private:
    void find_any(Tracing& tracing, std::size_t first, std::size_t n,
                  std::vector<RayHit>& hits) const override {
        std::array<RTCRay, chunk> rays;
        std::copy_n(&rays_[first], n, rays.begin());
        tracing.occluded(std::span(rays).first(n));
        put(first, n, hits, [&](std::size_t k) { return any_hit_by(rays[k].tfar); });
    }
    void find_closest(Tracing& tracing, std::size_t first, std::size_t n,
                      std::vector<RayHit>& hits) const override {
        std::array<RTCRayHit, chunk> rays;
        for (std::size_t k = 0; k < n; ++k) {
            rays[k].ray = rays_[first + k];
            rays[k].hit.geomID = RTC_INVALID_GEOMETRY_ID;
        }
        tracing.intersect(std::span(rays).first(n));
        put(first, n, hits, [&](std::size_t k) { return hit_in(rays[k]); });
    }

    std::vector<RTCRay> rays_;
};

/// One array for each number of the rays; Embree writes into tfar and the hits alone.
class StreamNp final : public Stream {
  public:
    StreamNp(const Job& job, const RaySettings& settings)
        : Stream(job, settings), time_(lanes_.size()), mask_(lanes_.size(), ~0u),
          zeros_(lanes_.size()) {
        for (const std::uint32_t lane : lanes_) {
            const Ray<float>& ray = ray_in(lane);
            for (int axis = 0; axis < 3; ++axis) {
                const auto a = static_cast<std::size_t>(axis);
                origin_[a].push_back(ray.origin[axis]);
                direction_[a].push_back(ray.direction[axis]);
            }
            tnear_.push_back(ray.t_min);
            tfar_.push_back(lane == no_ray ? before_start : ray.t_max);
        }
    }

  private:
    /// The rays from one on, of which Embree reads all but tfar.
    RTCRayNp rays_from(std::size_t first, float* tfar) const {
        const auto from = [first]<class T>(const std::vector<T>& numbers) {
            return const_cast<T*>(numbers.data() + first);
        };
        return {from(origin_[0]),    from(origin_[1]),    from(origin_[2]),
                from(tnear_),        from(direction_[0]), from(direction_[1]),
                from(direction_[2]), from(time_),         tfar,
                from(mask_),         from(zeros_),        from(zeros_)};
    }

    void find_any(Tracing& tracing, std::size_t first, std::size_t n,
                  std::vector<RayHit>& hits) const override {
        std::array<float, chunk> tfar;
        std::copy_n(&tfar_[first], n, tfar.begin());
        tracing.occluded(rays_from(first, tfar.data()), n);
        put(first, n, hits, [&](std::size_t k) { return any_hit_by(tfar[k]); });
    }
    void find_closest(Tracing& tracing, std::size_t first, std::size_t n,
                      std::vector<RayHit>& hits) const override {
        std::array<float, chunk> tfar, normal_x, normal_y, normal_z, u, v;
        std::array<unsigned, chunk> triangle, geometry, instance;
        std::copy_n(&tfar_[first], n, tfar.begin());
        std::fill_n(geometry.begin(), n, RTC_INVALID_GEOMETRY_ID);
        RTCRayHitNp query{rays_from(first, tfar.data()),
                          {normal_x.data(),
                           normal_y.data(),
                           normal_z.data(),
                           u.data(),
                           v.data(),
                           triangle.data(),
                           geometry.data(),
                           {instance.data()}}};
        tracing.intersect(query, n);
        put(first, n, hits, [&](std::size_t k) {
            return geometry[k] == RTC_INVALID_GEOMETRY_ID
                       ? RayHit{}
                       : RayHit{tfar[k], u[k], v[k], triangle[k]};
        });
    }

    std::array<std::vector<float>, 3> origin_, direction_;
    std::vector<float> tnear_, tfar_, time_;
    std::vector<unsigned> mask_, zeros_;
};

} // namespace

void append_embree_streams(std::vector<ContenderEntry>& all) {
    append_batches<Stream1M>(
        all, {"1M", "1m", "streams of 256 rays, a struct each", {ray_class::batches}});
    append_batches<StreamNp>(
        all, {"Np", "_np", "streams of 256 rays, an array for each number", {ray_class::batches}});
}

} // namespace boxwood::bench

#endif
