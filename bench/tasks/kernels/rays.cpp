#include "bench/tasks/kernels/kernel.h"
#include "kernels/registry.h"
#include "kernels/oracle/registry.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

/// The nearest hit over the triangles of each case. What a ray prepares it prepares once per case,
/// inside the timed loop.
template <class K> class Fans final : public Contender {
  public:
    explicit Fans(RayCases cases) : cases_(std::move(cases)) {}

    void build() override {}
    void query(Answers& answers) override {
        answers.hits.resize(cases_.rays.size());
        for (std::size_t i = 0; i < cases_.rays.size(); ++i)
            answers.hits[i] = nearest(cases_.rays[i]);
    }

  private:
    RayHit nearest(const RayCase& c) const {
        const auto per_ray = K::prepare(c.ray);
        RayHit best;
        float t_max = c.ray.t_max;
        for (std::uint32_t k = c.first; k < c.first + c.count; ++k) {
            RayHit hit;
            if (!K::intersect(per_ray, c.ray, cases_.triangles[k], t_max, hit))
                continue;
            t_max = hit.t;
            best = hit;
            best.triangle = k;
        }
        return best;
    }

    RayCases cases_;
};

} // namespace

std::vector<Rung> ray_rungs() {
    std::vector<Rung> all;
    for_each_kernel<Concatenated<RayKernels, oracle::RationalRayKernels>>(
        [&]<class K>(std::type_identity<K>) {
            all.push_back({K::info, precision_of<typename RealOf<K, float>::type>(),
                           called_one_by_one, [](const Cases& cases) {
                               return std::make_unique<Fans<K>>(std::get<RayCases>(cases));
                           }});
        });
    return all;
}

} // namespace boxwood::bench
