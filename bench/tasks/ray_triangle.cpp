/// Where a ray meets a triangle, or the nearest of a fan of them.

#include "bench/tasks/detail/kernel_task.h"
#include "kernels/oracle/registry.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

/// The nearest hit over the triangles of each case. What a ray prepares it prepares once per case,
/// inside the timed loop.
template <class K> class Fans final : public Contender {
  public:
    explicit Fans(RayCases cases) : cases_(std::move(cases)) {}

    void build() override {}
    void query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(cases_.rays.size());
        for (std::size_t i = 0; i < cases_.rays.size(); ++i)
            hits[i] = nearest(cases_.rays[i]);
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

const Task& ray_triangle_task() {
    using Kernels = Concatenated<RayKernels, oracle::RationalRayKernels>;
    static const KernelTaskOf<RayHit, RayCases> task(
        "ray_triangle", "of each case: where a ray meets a triangle or a fan",
        all_kernels<Kernels>([]<class K>(std::type_identity<K>) -> CaseKernel {
            return {K::info, precision_of<typename RealOf<K, float>::type>(), called_one_by_one,
                    [](const Cases& cases) {
                        return std::make_unique<Fans<K>>(std::get<RayCases>(cases));
                    }};
        }),
        make_fan_truth);
    return task;
}

} // namespace boxwood::bench
